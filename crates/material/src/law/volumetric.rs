//! Energies of the change of volume.

/// An energy `U(J)` per bulk modulus `K`; of neo-Hooke per Lamé's constant `λ`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Volumetric {
    /// `K/2 (J - 1)²`, as in Abaqus with `D1 = 2/K`. It stays finite as `J → 0`.
    Linear,
    /// `K/4 (J² - 1 - 2 ln J)`: convex (Simo & Taylor 1982).
    #[default]
    Quadratic,
    /// `K/2 ln² J`, as in FEBio: convex below `J = e`.
    Logarithmic,
}

impl Volumetric {
    /// `U`, `U'`, `U''` at a change of volume.
    pub fn energy(self, modulus: f64, j: f64) -> [f64; 3] {
        match self {
            Volumetric::Linear => [0.5 * modulus * (j - 1.0).powi(2), modulus * (j - 1.0), modulus],
            Volumetric::Quadratic => [
                0.25 * modulus * (j * j - 1.0 - 2.0 * j.ln()),
                0.5 * modulus * (j - 1.0 / j),
                0.5 * modulus * (1.0 + 1.0 / (j * j)),
            ],
            Volumetric::Logarithmic => {
                let log = j.ln();
                [0.5 * modulus * log * log, modulus * log / j, modulus * (1.0 - log) / (j * j)]
            }
        }
    }

    /// As it is written with a modulus.
    pub(super) fn formula(self, modulus: &str) -> String {
        match self {
            Volumetric::Linear => format!("U = {modulus}/2 (J - 1)^2"),
            Volumetric::Quadratic => format!("U = {modulus}/4 (J^2 - 1 - 2 ln J)"),
            Volumetric::Logarithmic => format!("U = {modulus}/2 ln^2 J"),
        }
    }
}

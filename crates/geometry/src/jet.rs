//! Scalars that carry exact first and second derivatives with respect to position.
//!
//! A [`Jet`] is a truncated Taylor expansion `f + g·dx + ½ dx·H dx`. Arithmetic on jets is the chain rule, so an
//! expression evaluated on jets yields its value, gradient and Hessian to round-off.

use crate::{Matrix, Vector};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The arithmetic an expression needs, on plain numbers and on jets alike.
pub trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// A constant.
    fn constant(value: f64) -> Self;
    /// The value without derivatives.
    fn value(&self) -> f64;
    /// Whether all derivatives vanish.
    fn is_constant(&self) -> bool;
    /// A scalar function, given its value and first two derivatives at `self.value()`.
    fn chain(self, f: f64, df: f64, ddf: f64) -> Self;

    /// `self` to a constant power.
    fn powf(self, n: f64) -> Self {
        let x = self.value();
        if n == 0.0 {
            return Self::constant(1.0);
        }
        // A vanishing factor stands before the power that would be infinite at zero.
        let d1 = n * x.powf(n - 1.0);
        let d2 = if n == 1.0 { 0.0 } else { n * (n - 1.0) * x.powf(n - 2.0) };
        self.chain(x.powf(n), d1, d2)
    }
}

impl Real for f64 {
    fn constant(value: f64) -> Self {
        value
    }
    fn value(&self) -> f64 {
        *self
    }
    fn is_constant(&self) -> bool {
        true
    }
    fn chain(self, f: f64, _: f64, _: f64) -> Self {
        f
    }
    fn powf(self, n: f64) -> Self {
        f64::powf(self, n)
    }
}

/// Value, gradient and Hessian of a scalar field at one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<const D: usize> {
    pub value: f64,
    pub gradient: Vector<D>,
    pub hessian: Matrix<D>,
}

impl<const D: usize> Jet<D> {
    /// The `k`-th coordinate as a field.
    pub fn variable(value: f64, k: usize) -> Self {
        let mut jet = Self::constant(value);
        jet.gradient[k] = 1.0;
        jet
    }

    /// The expansion at steps from its point that vanish but for what they carry as jets: that is chained through it. Jets
    /// end with the second order, and so does this; along steps that carry nothing no derivative is read.
    pub fn expanded<R: Real>(&self, steps: [R; D]) -> R {
        let c = R::constant;
        let first = (0..D)
            .filter(|&i| !steps[i].is_constant())
            .fold(c(self.value), |sum, i| sum + c(self.gradient[i]) * steps[i]);
        let carries = |&(i, j): &(usize, usize)| !steps[i].is_constant() && !steps[j].is_constant();
        let pairs = (0..D).flat_map(|i| (i..D).map(move |j| (i, j))).filter(carries);
        pairs.fold(first, |sum, (i, j)| {
            let share = if i == j { 0.5 } else { 1.0 };
            sum + c(share * self.hessian[(i, j)]) * steps[i] * steps[j]
        })
    }

    /// Trace of the Hessian.
    pub fn laplacian(&self) -> f64 {
        self.hessian.trace()
    }

    /// Whether value and all derivatives are finite numbers.
    pub fn is_finite(&self) -> bool {
        self.value.is_finite()
            && self.gradient.iter().all(|v| v.is_finite())
            && self.hessian.iter().all(|v| v.is_finite())
    }
}

/// The elementary functions, for fields that a program states.
impl<const D: usize> Jet<D> {
    #[must_use]
    pub fn sin(self) -> Self {
        let (sin, cos) = self.value.sin_cos();
        self.chain(sin, cos, -sin)
    }

    #[must_use]
    pub fn cos(self) -> Self {
        let (sin, cos) = self.value.sin_cos();
        self.chain(cos, -sin, -cos)
    }

    #[must_use]
    pub fn exp(self) -> Self {
        let e = self.value.exp();
        self.chain(e, e, e)
    }

    #[must_use]
    pub fn ln(self) -> Self {
        let r = 1.0 / self.value;
        self.chain(self.value.ln(), r, -r * r)
    }

    #[must_use]
    pub fn sqrt(self) -> Self {
        self.powf(0.5)
    }
}

impl<const D: usize> Real for Jet<D> {
    fn constant(value: f64) -> Self {
        Self { value, gradient: Vector::zeros(), hessian: Matrix::zeros() }
    }
    fn value(&self) -> f64 {
        self.value
    }
    fn is_constant(&self) -> bool {
        self.gradient == Vector::<D>::zeros() && self.hessian == Matrix::<D>::zeros()
    }
    fn chain(self, f: f64, df: f64, ddf: f64) -> Self {
        // A constant argument stays constant even where the derivative of the function is infinite.
        if self.is_constant() {
            return Self::constant(f);
        }
        Self {
            value: f,
            gradient: self.gradient * df,
            hessian: self.hessian * df + self.gradient * self.gradient.transpose() * ddf,
        }
    }
}

impl<const D: usize> Add for Jet<D> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self { value: self.value + o.value, gradient: self.gradient + o.gradient, hessian: self.hessian + o.hessian }
    }
}

impl<const D: usize> Sub for Jet<D> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self { value: self.value - o.value, gradient: self.gradient - o.gradient, hessian: self.hessian - o.hessian }
    }
}

impl<const D: usize> Neg for Jet<D> {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, gradient: -self.gradient, hessian: -self.hessian }
    }
}

impl<const D: usize> Mul for Jet<D> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let cross = self.gradient * o.gradient.transpose();
        Self {
            value: self.value * o.value,
            gradient: self.gradient * o.value + o.gradient * self.value,
            hessian: self.hessian * o.value + o.hessian * self.value + cross + cross.transpose(),
        }
    }
}

impl<const D: usize> Div for Jet<D> {
    type Output = Self;
    #[allow(clippy::suspicious_arithmetic_impl)] // a quotient is a product with the reciprocal
    fn div(self, o: Self) -> Self {
        let r = 1.0 / o.value;
        self * o.chain(r, -r * r, 2.0 * r * r * r)
    }
}

impl<const D: usize> Add<f64> for Jet<D> {
    type Output = Self;
    fn add(self, c: f64) -> Self {
        Self { value: self.value + c, ..self }
    }
}

impl<const D: usize> Sub<f64> for Jet<D> {
    type Output = Self;
    fn sub(self, c: f64) -> Self {
        Self { value: self.value - c, ..self }
    }
}

impl<const D: usize> Mul<f64> for Jet<D> {
    type Output = Self;
    fn mul(self, c: f64) -> Self {
        Self { value: self.value * c, gradient: self.gradient * c, hessian: self.hessian * c }
    }
}

impl<const D: usize> Div<f64> for Jet<D> {
    type Output = Self;
    fn div(self, c: f64) -> Self {
        Self { value: self.value / c, gradient: self.gradient / c, hessian: self.hessian / c }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_dual::DualNum;

    /// The same formula on our jets and on the hyper-dual numbers of `num-dual`.
    #[test]
    fn jets_agree_with_an_independent_automatic_differentiation() {
        for &(x, y) in &[(0.3, -1.2), (2.0, 0.7), (-0.4, 0.1)] {
            let (jx, jy) = (Jet::<2>::variable(x, 0), Jet::<2>::variable(y, 1));
            let s = jx * jx + jy * jy;
            let sin = s.sin();
            let jet = sin / (jx * jy + 2.0) - s.powf(1.5) + (s * 0.5 - 0.1).cos().exp() / 3.0 - s.sqrt().ln();
            let (f, gradient, hessian) = num_dual::hessian(
                |v| {
                    let s = v[0] * v[0] + v[1] * v[1];
                    s.sin() / (v[0] * v[1] + 2.0) - s.powf(1.5) + (s * 0.5 - 0.1).cos().exp() / 3.0 - s.sqrt().ln()
                },
                &nalgebra::SVector::<f64, 2>::new(x, y),
            );
            assert!((jet.value - f).abs() < 1e-13);
            assert!((jet.gradient - gradient).norm() < 1e-12);
            assert!((jet.hessian - hessian).norm() < 1e-11);
        }
    }

    #[test]
    fn powers_at_zero_have_no_spurious_infinities() {
        let x = Jet::<1>::variable(0.0, 0);
        let square = x.powf(2.0);
        assert_eq!((square.value, square.gradient[0], square.hessian[0]), (0.0, 0.0, 2.0));
        assert!(x.powf(1.0).is_finite());
    }
}

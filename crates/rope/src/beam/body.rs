pub struct Beam; pub struct BeamError;

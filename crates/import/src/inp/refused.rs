//! Keywords that have no counterpart here, with the reason, and those that change nothing in the results.

/// Keywords without influence on displacements, stresses or contact.
const WITHOUT_INFLUENCE: [&str; 38] = [
    "HEADING",
    "NODEPRINT",
    "NODEFILE",
    "NODEOUTPUT",
    "ELPRINT",
    "ELFILE",
    "ELEMENTOUTPUT",
    "CONTACTPRINT",
    "CONTACTFILE",
    "CONTACTOUTPUT",
    "ENERGYPRINT",
    "ENERGYOUTPUT",
    "ENERGYFILE",
    "OUTPUT",
    "FILEOUTPUT",
    "FILEFORMAT",
    "SECTIONPRINT",
    "SECTIONFILE",
    "PREPRINT",
    "PRINT",
    "RESTART",
    "MONITOR",
    "CONTROLS",
    "CONTACTCONTROLS",
    "SECTIONCONTROLS",
    "HOURGLASSSTIFFNESS",
    "TIMEPOINTS",
    "ENDSTEP",
    "DENSITY",
    "DAMPING",
    "PHYSICALCONSTANTS",
    "DISPLAYBODY",
    "SOLVERCONTROLS",
    "DIAGNOSTICS",
    "FILTER",
    "NOUTPUT",
    "CONDUCTIVITY",
    "SPECIFICHEAT",
];

/// What is said of heat.
const HEAT: &str =
    "heat is not imported; state `thermal` of bodies, supports with a temperature and `contacts.NAME.heat` in the case";

/// Keywords that cannot be imported, and why.
const REFUSED: [(&str, &str); 47] = [
    ("TEMPERATURE", "temperatures of nodes are not imported; state `thermal.temperature` of a body in the case"),
    ("HEATTRANSFER", HEAT),
    ("COUPLEDTEMPERATURE-DISPLACEMENT", HEAT),
    ("UNCOUPLEDTEMPERATURE-DISPLACEMENT", HEAT),
    ("CFLUX", HEAT),
    ("DFLUX", HEAT),
    ("FILM", HEAT),
    ("RADIATE", HEAT),
    ("GAPCONDUCTANCE", HEAT),
    ("DYNAMIC", "dynamics do not exist here"),
    ("MODALDYNAMIC", "dynamics do not exist here"),
    ("STEADYSTATEDYNAMICS", "dynamics do not exist here"),
    ("FREQUENCY", "natural frequencies do not exist here"),
    ("COMPLEXFREQUENCY", "natural frequencies do not exist here"),
    ("BUCKLE", "linear buckling does not exist here"),
    ("VISCO", "creep and viscosity do not exist here"),
    ("CREEP", "creep and viscosity do not exist here"),
    ("VISCOELASTIC", "creep and viscosity do not exist here"),
    ("NOANALYSIS", "the deck asks for no analysis"),
    ("SENSITIVITY", "sensitivities do not exist here"),
    ("GREEN", "Green functions do not exist here"),
    ("SUBSTRUCTUREGENERATE", "substructures do not exist here"),
    ("SHELLSECTION", "shells do not exist here"),
    ("MEMBRANESECTION", "membranes in space do not exist here"),
    ("BEAMSECTION", "beams are not imported"),
    ("BEAMGENERALSECTION", "beams are not imported"),
    ("FLUIDSECTION", "fluids do not exist here"),
    ("SPRING", "springs between nodes do not exist here"),
    ("DASHPOT", "dashpots do not exist here"),
    ("GAP", "gap elements do not exist here; use *CONTACT PAIR"),
    ("MASS", "point masses do not exist here"),
    ("MPC", "multi-point constraints do not exist here; *EQUATION of equal displacements does"),
    ("COUPLING", "couplings do not exist here"),
    ("KINEMATIC", "couplings do not exist here"),
    ("DISTRIBUTINGCOUPLING", "couplings do not exist here"),
    ("CYCLICSYMMETRYMODEL", "cyclic symmetry does not exist here"),
    ("SUBMODEL", "submodels do not exist here"),
    ("PRE-TENSIONSECTION", "pre-tension sections do not exist here"),
    ("MODELCHANGE", "parts that appear or vanish do not exist here"),
    ("USERMATERIAL", "materials of user routines do not exist here"),
    ("UMAT", "materials of user routines do not exist here"),
    ("DEFORMATIONPLASTICITY", "Ramberg-Osgood plasticity does not exist here"),
    ("HYPERFOAM", "the Ogden-Storakers foam does not exist here"),
    ("CYCLICHARDENING", "cyclic hardening does not exist here"),
    ("CLEARANCE", "gaps other than those of the mesh do not exist here"),
    ("CONTACT", "general contact is not imported; use *CONTACT PAIR"),
    ("DSFLUX", HEAT),
];

pub(super) fn is_without_influence(name: &str) -> bool {
    WITHOUT_INFLUENCE.contains(&name)
}

/// Why a keyword cannot be imported.
pub(super) fn reason(name: &str) -> Option<&'static str> {
    REFUSED.iter().find(|(known, _)| *known == name).map(|(_, reason)| *reason)
}

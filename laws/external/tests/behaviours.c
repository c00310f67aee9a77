/* Behaviours of our own for the tests, by the generic interface as it is documented: what a compiled MFront file offers. */

typedef struct {
  const double *gradients;
  double *forces;
  const double *mass_density, *material_properties;
  double *internal_variables, *stored_energy, *dissipated_energy;
  const double *external_variables;
} State;

typedef struct {
  char *error_message;
  double dt;
  double *K, *rdt, *speed_of_sound;
  State s0, s1;
} Data;

typedef const char *Text;

#define DESCRIBE(NAME, INTERFACE, VERSION, TYPE, KINEMATIC, HYPOTHESIS, GRADIENT, FORCE, ENERGIES)                        \
  Text NAME##_mfront_ept = #NAME, NAME##_mfront_interface = INTERFACE, NAME##_unit_system = "SI";                          \
  unsigned short NAME##_mfront_mkt = 1, NAME##_api_version = VERSION, NAME##_BehaviourType = TYPE,                         \
                 NAME##_BehaviourKinematic = KINEMATIC, NAME##_SymmetryType = 0, NAME##_ElasticSymmetryType = 0,           \
                 NAME##_nModellingHypotheses = 1, NAME##_nGradients = 1, NAME##_nThermodynamicForces = 1,                  \
                 NAME##_requiresStiffnessTensor = 0, NAME##_requiresThermalExpansionCoefficientTensor = 0,                 \
                 NAME##_nExternalStateVariables = 0, NAME##_ComputesInternalEnergy = ENERGIES,                             \
                 NAME##_ComputesDissipatedEnergy = ENERGIES;                                                               \
  Text NAME##_ModellingHypotheses[1] = {HYPOTHESIS}, NAME##_Gradients[1] = {GRADIENT},                                    \
       NAME##_ThermodynamicForces[1] = {FORCE};

#define JOINT(NAME, INTERFACE, VERSION)                                                                                    \
  DESCRIBE(NAME, INTERFACE, VERSION, 3, 2, "PlaneStrain", "OpeningDisplacement", "CohesiveForce", 1)                      \
  unsigned short NAME##_nMaterialProperties = 4, NAME##_nInternalStateVariables = 1;                                      \
  Text NAME##_MaterialProperties[4] = {"NormalStiffness", "ShearStiffness", "Strength", "FractureEnergy"},                \
       NAME##_InternalStateVariables[1] = {"Damage"};                                                                      \
  int NAME##_InternalStateVariablesTypes[1] = {0};

/* Bilinear bond: damage by opening alone, secant unloading, stiff in compression. */
JOINT(BilinearBond, "Generic", 1)

int BilinearBond_PlaneStrain(Data *d) {
  const double *p = d->s0.material_properties, *g = d->s1.gradients;
  const double kn = p[0], kt = p[1], onset = p[2] / kn, end = 2 * p[3] / p[2];
  const double un = g[0] > 0 ? g[0] : 0, d0 = d->s0.internal_variables[0];
  double damage = un > onset ? end * (un - onset) / (un * (end - onset)) : 0, by = 0;
  if (damage > 1) damage = 1;
  if (damage <= d0) damage = d0;
  else if (damage < 1) by = end * onset / (un * un * (end - onset));
  d->s1.internal_variables[0] = damage;
  d->s1.forces[0] = g[0] > 0 ? (1 - damage) * kn * g[0] : kn * g[0];
  d->s1.forces[1] = (1 - damage) * kt * g[1];
  *d->s1.stored_energy =
      0.5 * (1 - damage) * (kn * un * un + kt * g[1] * g[1]) + (g[0] < 0 ? 0.5 * kn * g[0] * g[0] : 0);
  /* Integral of kn u^2 / 2 over the damage: exact in opening, so that long steps keep the balance of energy. */
  const double from = end * onset / (end - d0 * (end - onset)), to = end * onset / (end - damage * (end - onset));
  *d->s1.dissipated_energy = *d->s0.dissipated_energy + 0.5 * kn * end * onset / (end - onset) * (to - from) +
                             0.5 * kt * g[1] * g[1] * (damage - d0);
  if (d->K[0] > 3.5) {
    d->K[0] = g[0] > 0 ? (1 - damage) * kn - kn * g[0] * by : kn;
    d->K[1] = 0;
    d->K[2] = -kt * g[1] * by;
    d->K[3] = (1 - damage) * kt;
  }
  return 1;
}

/* The same signature for behaviours that go wrong. */
JOINT(OldBond, "Generic", 0)
int OldBond_PlaneStrain(Data *d) { return BilinearBond_PlaneStrain(d); }
JOINT(OtherBond, "Aster", 1)
int OtherBond_PlaneStrain(Data *d) { return BilinearBond_PlaneStrain(d); }
JOINT(FragileBond, "Generic", 1)
int FragileBond_PlaneStrain(Data *d) {
  static const char why[] = "opened too far";
  if (d->s1.gradients[0] > 1e-3) {
    for (unsigned i = 0; i < sizeof why; ++i) d->error_message[i] = why[i];
    return -1;
  }
  if (d->s1.gradients[0] > 1e-4) return 0;
  int code = BilinearBond_PlaneStrain(d);
  if (d->s1.gradients[1] > 1e-4) d->s1.forces[1] = 0.0 / (d->s1.gradients[1] - d->s1.gradients[1]);
  return code;
}

/* One that crashes, and one that ends its process. */
JOINT(CrashingBond, "Generic", 1)
int CrashingBond_PlaneStrain(Data *d) {
  if (d->s1.gradients[0] > 5e-5) *(volatile int *)0 = 1;
  return BilinearBond_PlaneStrain(d);
}

/* A crystal with three different shear moduli; it says nothing of its energies. */
DESCRIBE(Crystal, "Generic", 1, 1, 1, "Tridimensional", "Strain", "Stress", 0)
unsigned short Crystal_nMaterialProperties = 4, Crystal_nInternalStateVariables = 0;
Text Crystal_MaterialProperties[4] = {"Modulus", "Shear12", "Shear13", "Shear23"};

int Crystal_Tridimensional(Data *d) {
  const double *p = d->s0.material_properties;
  /* Library order: xx, yy, zz, sqrt(2) xy, sqrt(2) xz, sqrt(2) yz; sqrt(2) s = 2 G (sqrt(2) e). */
  for (int i = 0; i < 6; ++i) {
    const double c = i < 3 ? p[0] : 2 * p[i - 2];
    d->s1.forces[i] = c * d->s1.gradients[i];
    for (int j = 0; j < 6; ++j) d->K[6 * i + j] = i == j ? c : 0;
  }
  return 1;
}

/* Yields along x; keeps its elastic strain, as MFront's implicit behaviours do, and nothing else. */
DESCRIBE(Yielding, "Generic", 1, 1, 1, "Tridimensional", "Strain", "Stress", 0)
unsigned short Yielding_nMaterialProperties = 2, Yielding_nInternalStateVariables = 1;
Text Yielding_MaterialProperties[2] = {"Modulus", "Strength"}, Yielding_InternalStateVariables[1] = {"ElasticStrain"};
int Yielding_InternalStateVariablesTypes[1] = {1};

int Yielding_Tridimensional(Data *d) {
  const double modulus = d->s0.material_properties[0], most = d->s0.material_properties[1] / modulus;
  for (int i = 0; i < 6; ++i) {
    double strain = d->s0.internal_variables[i] + d->s1.gradients[i] - d->s0.gradients[i], slope = modulus;
    if (i == 0 && (strain > most || strain < -most)) strain = strain > 0 ? most : -most, slope = 0;
    d->s1.internal_variables[i] = strain;
    d->s1.forces[i] = modulus * strain;
    for (int j = 0; j < 6; ++j) d->K[6 * i + j] = i == j ? slope : 0;
  }
  return 1;
}

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

/* Behaviours that break the interface. Each is the bilinear bond at rest, and another thing once it opens. */
#define HOSTILE(NAME, DOES)                                                                                                \
  JOINT(NAME, "Generic", 1)                                                                                                \
  int NAME##_PlaneStrain(Data *d) {                                                                                        \
    int code = BilinearBond_PlaneStrain(d);                                                                                \
    if (d->s1.gradients[0] > 5e-5) { DOES; }                                                                               \
    return code;                                                                                                           \
  }
HOSTILE(NanForce, d->s1.forces[0] = __builtin_nan(""))
HOSTILE(InfTangent, d->K[3] = __builtin_inf())
HOSTILE(NanState, d->s1.internal_variables[0] = __builtin_nan(""))
HOSTILE(InfEnergy, *d->s1.stored_energy = __builtin_inf())
HOSTILE(LongForces, d->s1.forces[2] = 1)
HOSTILE(EarlyForces, d->s1.forces[-1] = 1)
HOSTILE(LongState, d->s1.internal_variables[1] = 1)
HOSTILE(LongTangent, for (int i = 36; i < 40; ++i) d->K[i] = 1)
HOSTILE(LongMessage, for (int i = 0; i < 540; ++i) d->error_message[i] = 'x'; return -1)
HOSTILE(FullMessage, for (int i = 0; i < 512; ++i) d->error_message[i] = 'x'; return -1)
HOSTILE(RawMessage, d->error_message[0] = 27; d->error_message[1] = '['; d->error_message[2] = (char)0xff; return -1)
HOSTILE(WritesStart, d->s0.internal_variables[0] = 1)
HOSTILE(WritesProperties, *(double *)d->s0.material_properties = 1)
HOSTILE(WritesGradients, *(double *)d->s1.gradients = 1)
HOSTILE(WritesPointers, d->s1.forces = d->K = d->s0.stored_energy = 0; d->error_message = 0)
HOSTILE(StrangeCode, return 42)
HOSTILE(LeastCode, return -2147483647 - 1)
HOSTILE(Endless, for (volatile int i = 0;; ++i) if (i > 1000) i = 0)
HOSTILE(Closes, ((int (*)(int))0)(0))

/* Behaviours that say wrong things of themselves. */
#define SAYS(NAME, N_STATE, STATE, TYPE)                                                                                   \
  DESCRIBE(NAME, "Generic", 1, 3, 2, "PlaneStrain", "OpeningDisplacement", "CohesiveForce", 1)                            \
  unsigned short NAME##_nMaterialProperties = 0, NAME##_nInternalStateVariables = N_STATE;                                \
  Text NAME##_InternalStateVariables[65535] = STATE;                                                                       \
  int NAME##_InternalStateVariablesTypes[65535] = {TYPE};                                                                  \
  int NAME##_PlaneStrain(Data *d) { (void)d; return 1; }
#define ONE {"a"}
SAYS(NullName, 2, ONE, 0)
SAYS(OddType, 1, ONE, -1)
SAYS(HugeType, 1, ONE, 2147483647)
SAYS(NoState, 0, ONE, 0)
#define MANY {[0 ... 65534] = "a"}
SAYS(HugeState, 65535, MANY, 3)

DESCRIBE(NoFunction, "Generic", 1, 3, 2, "PlaneStrain", "OpeningDisplacement", "CohesiveForce", 1)
unsigned short NoFunction_nMaterialProperties = 0, NoFunction_nInternalStateVariables = 0;
DESCRIBE(NoCounts, "Generic", 1, 3, 2, "PlaneStrain", "OpeningDisplacement", "CohesiveForce", 1)
int NoCounts_PlaneStrain(Data *d) { (void)d; return 1; }
JOINT(NewerBond, "Generic", 65535)
int NewerBond_PlaneStrain(Data *d) { return BilinearBond_PlaneStrain(d); }

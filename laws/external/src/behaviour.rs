//! A behaviour: its description, checked against the study, and the integration of a step.

use crate::buffers::{Buffer, Buffers};
use crate::data::{API_VERSION, BehaviourData, CONSISTENT_TANGENT, Integrate, MESSAGE, State};
use crate::library::{Symbols, open};
use std::collections::BTreeMap;
use std::sync::{LazyLock, Mutex, PoisonError};
use voussoir_core::law::{Effect, UpdateBranch, UpdateFailure};
use voussoir_core::plugin::nearest;

/// The description of a behaviour in a study.
pub(crate) struct Request<'a> {
    pub library: &'a str,
    pub behaviour: &'a str,
    pub properties: &'a BTreeMap<String, f64>,
    pub variables: &'a BTreeMap<String, f64>,
    /// Temperature \[K\].
    pub temperature: f64,
    /// Density \[kg/m³\].
    pub density: f64,
}

/// The behaviours that a kind of law supports.
pub(crate) struct Family {
    /// Modelling hypothesis.
    pub hypothesis: &'static str,
    /// `_BehaviourType` and `_BehaviourKinematic`.
    pub kind: [u16; 2],
    /// Description in words.
    pub words: &'static str,
    /// Names of gradient and force.
    pub names: [&'static str; 2],
    /// Numbers of components of a scalar, a symmetric tensor, a vector and a tensor.
    pub sizes: [usize; 4],
}

impl Family {
    /// Cohesive zone models, for joints.
    pub const COHESIVE_ZONE: Family = Family {
        hypothesis: "PlaneStrain",
        kind: [3, 2],
        words: "cohesive zone model",
        names: ["OpeningDisplacement", "CohesiveForce"],
        sizes: [1, 4, 2, 5],
    };
    /// Behaviours of small strains, for materials.
    pub const SMALL_STRAIN: Family = Family {
        hypothesis: "Tridimensional",
        kind: [1, 1],
        words: "behaviour of small strains",
        names: ["Strain", "Stress"],
        sizes: [1, 6, 3, 9],
    };
}

/// A behaviour with its parameters.
#[derive(Debug)]
pub(crate) struct Behaviour {
    integrate: Integrate,
    properties: Vec<f64>,
    external: Vec<f64>,
    density: f64,
    /// Number of its own state variables.
    internal: usize,
    /// Place of the elastic strain in its own state, identified by MFront's name for it.
    elastic_strain: Option<usize>,
    /// Names of the whole state.
    pub names: &'static [&'static str],
    /// True if it reports stored and dissipated energy.
    energies: bool,
}

/// The result of a step, in the order and sign of the interface.
pub(crate) struct Step<const N: usize> {
    pub forces: [f64; N],
    pub tangent: [[f64; N]; N],
    pub branch: UpdateBranch,
    pub stored: f64,
    pub dissipated: f64,
}

/// Greatest number of gradients.
const LARGEST: usize = 6;
/// Greatest number of internal variables: each point of a structure stores them.
const MAX_STATE: usize = 10_000;

/// The buffers that a library writes.
struct End {
    tangent: Buffer,
    forces: Buffer,
    internal: Buffer,
    stored: Buffer,
    dissipated: Buffer,
}

/// True if the state of the behaviour changed.
pub(crate) const INELASTIC: UpdateBranch = UpdateBranch::new("inelastic", Effect::Yielding);

/// Key of the study and the fault.
pub(crate) type Wrong = Vec<(String, String)>;

pub(crate) fn wrong<T>(key: &str, message: String) -> Result<T, Wrong> {
    Err(vec![(key.into(), message)])
}

/// Texts and lists of texts with the lifetime of the program, each stored once.
#[derive(Default)]
struct Kept {
    texts: Vec<&'static str>,
    lists: Vec<&'static [&'static str]>,
}

static KEPT: LazyLock<Mutex<Kept>> = LazyLock::new(Mutex::default);

impl Kept {
    fn text(&mut self, text: &str) -> &'static str {
        if let Some(own) = self.texts.iter().find(|own| **own == text) {
            return own;
        }
        let own: &'static str = Box::leak(text.to_owned().into_boxed_str());
        self.texts.push(own);
        own
    }

    fn list(&mut self, texts: &[String]) -> &'static [&'static str] {
        if let Some(own) = self.lists.iter().find(|own| own.iter().eq(texts.iter())) {
            return own;
        }
        let own: &'static [&'static str] = Vec::leak(texts.iter().map(|text| self.text(text)).collect());
        self.lists.push(own);
        own
    }
}

/// Greatest number of messages that are stored word by word; a library may produce any number of different messages.
const MESSAGES: usize = 1000;

/// Returns the list of texts with the lifetime of the program.
pub(crate) fn names(texts: &[String]) -> &'static [&'static str] {
    KEPT.lock().unwrap_or_else(PoisonError::into_inner).list(texts)
}

/// Returns a text with the lifetime of the program.
pub(crate) fn message(text: &str) -> &'static str {
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    if kept.texts.len() < MESSAGES { kept.text(text) } else { "the external behaviour could not integrate the step" }
}

/// Returns the values in the order of `names`. Each must be given, and no other.
fn ordered(key: &str, names: &[String], given: &BTreeMap<String, f64>) -> Result<Vec<f64>, Wrong> {
    let mut complaints = Vec::new();
    for name in given.keys().filter(|name| !names.contains(name)) {
        let meant = nearest(name, names.iter().map(String::as_str));
        let meant = meant.map_or(String::new(), |meant| format!("; did you mean {meant}?"));
        complaints.push((format!("{key}.{name}"), format!("the behaviour has no such entry{meant}")));
    }
    let missing: Vec<&str> = names.iter().filter(|name| !given.contains_key(*name)).map(String::as_str).collect();
    if !missing.is_empty() {
        complaints.push((key.into(), format!("the behaviour needs {}", missing.join(", "))));
    }
    if !complaints.is_empty() {
        return Err(complaints);
    }
    Ok(names.iter().map(|name| given[name]).collect())
}

/// Returns the tangent in the initial state, from a step without strain.
pub(crate) fn check_rest<const N: usize>(step: Result<Step<N>, UpdateFailure>) -> Result<[[f64; N]; N], Wrong> {
    match step {
        Err(why) => wrong("behaviour", format!("it refuses a step from rest to rest: {why}")),
        Ok(step) if (0..N).any(|i| step.tangent[i][i] <= 0.0) => {
            wrong("behaviour", format!("its tangent at rest is not stiff: {:?}", step.tangent))
        }
        Ok(step) if step.forces.iter().any(|force| *force != 0.0) => {
            wrong("behaviour", format!("it carries {:?} at rest", step.forces))
        }
        Ok(step) => Ok(step.tangent),
    }
}

/// Checks the input of a step: finite numbers, and states of the behaviour's `size`.
pub(crate) fn check_step(gradients: &[f64], old: &[f64], new: &[f64], size: usize) -> Result<(), UpdateFailure> {
    if !gradients.iter().chain(old).all(|x| x.is_finite()) {
        return Err(UpdateFailure::NotFinite);
    }
    if old.len() != size || new.len() != size {
        return Err(UpdateFailure::WrongSize);
    }
    Ok(())
}

impl Behaviour {
    /// Opens the library and checks the behaviour. An error names the key of the study and the fault.
    pub fn load<const N: usize>(request: &Request, family: &Family) -> Result<Self, Wrong> {
        let library = open(request.library).or_else(|why| wrong("library", why))?;
        let symbols = Symbols { library, behaviour: request.behaviour, hypothesis: family.hypothesis };
        let energies = check_family(&symbols, request, family)?;
        let mut names = symbols.names("MaterialProperties").ok_or_else(|| missing("MaterialProperties"))?;
        if symbols.number("requiresStiffnessTensor") == Some(1) {
            names.splice(0..0, ["YoungModulus".to_string(), "PoissonRatio".into()]);
        }
        let properties = ordered("properties", &names, request.properties)?;
        let mut names = symbols.names("ExternalStateVariables").ok_or_else(|| missing("ExternalStateVariables"))?;
        // The temperature comes first, whether the library lists it or not.
        if symbols.number("TemperatureRemovedFromExternalStateVariables") == Some(0) {
            names.retain(|name| name != "Temperature");
        }
        let mut external = vec![request.temperature];
        external.extend(ordered("variables", &names, request.variables)?);
        let variables = symbols.names("InternalStateVariables").ok_or_else(|| missing("InternalStateVariables"))?;
        let types = symbols
            .types("InternalStateVariables", variables.len())
            .ok_or_else(|| missing("InternalStateVariablesTypes"))?;
        let (mut state, mut elastic_strain) = (Vec::new(), None);
        for (name, kind) in variables.iter().zip(types) {
            let size = usize::try_from(kind).ok().and_then(|kind| family.sizes.get(kind));
            let Some(&size) = size else {
                return wrong(
                    "behaviour",
                    format!("its internal variable {name} is of a type that is not known, {kind}"),
                );
            };
            if name == "ElasticStrain" && size == N {
                elastic_strain = Some(state.len());
            }
            state.extend((0..size).map(|i| if size == 1 { format!("{name} [-]") } else { format!("{name}_{i} [-]") }));
        }
        let internal = state.len();
        if internal > MAX_STATE {
            return wrong("behaviour", format!("its state has {internal} numbers; at most {MAX_STATE} are read"));
        }
        state.extend((0..N).map(|i| format!("gradient_{i} [-]")).chain((0..N).map(|i| format!("force_{i} [Pa]"))));
        state.extend(["stored [J]".to_string(), "dissipated [J]".into()]);
        let names = self::names(&state);
        let Some(integrate) = symbols.function() else {
            let symbol = format!("{}_{}", request.behaviour, family.hypothesis);
            return wrong("behaviour", format!("the library has no function {symbol}"));
        };
        let density = request.density;
        let behaviour =
            Behaviour { integrate, properties, external, density, internal, elastic_strain, names, energies };
        let rest = vec![0.0; behaviour.names.len()];
        check_rest(behaviour.step([0.0; N], 0.0, &rest, &mut rest.clone()))?;
        Ok(behaviour)
    }

    /// Integrates a step. The state consists of the behaviour's own state, then gradients, forces and energies at the
    /// start of the step. An error is the message of the behaviour, a wrong length or a number that is not finite.
    pub fn step<const N: usize>(
        &self,
        gradients: [f64; N],
        time_step: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<Step<N>, UpdateFailure> {
        check_step(&gradients, old, new, self.names.len())?;
        if N > LARGEST {
            return Err(UpdateFailure::WrongSize);
        }
        new.copy_from_slice(old);
        let (own, rest) = old.split_at(self.internal);
        let before: [f64; N] = std::array::from_fn(|i| rest[i]);
        let (from, energies) = (&rest[N..2 * N], &rest[2 * N..]);
        let mut buffers = Buffers::empty();
        let called = self.call(&mut buffers, &gradients, time_step, &before, (own, from, energies));
        let answer = called.map(|end| {
            let answer = |buffer| buffers.numbers(buffer);
            let forces: [f64; N] = std::array::from_fn(|i| answer(&end.forces)[i]);
            let tangent: [[f64; N]; N] =
                std::array::from_fn(|i| std::array::from_fn(|j| answer(&end.tangent)[i * N + j]));
            new[..self.internal].copy_from_slice(answer(&end.internal));
            (forces, tangent, answer(&end.stored)[0], answer(&end.dissipated)[0])
        });
        buffers.keep();
        let (forces, tangent, mut stored, mut dissipated) = answer.map_err(UpdateFailure::Law)?;
        let work: f64 = (0..N).map(|i| 0.5 * (rest[N + i] + forces[i]) * (gradients[i] - before[i])).sum();
        if !self.energies {
            // The dissipated energy is not known: all work counts as stored.
            (stored, dissipated) = (rest[2 * N] + work, 0.0);
        }
        let lost = dissipated - rest[2 * N + 1];
        let inelastic = self.inelastic(&before, &gradients, old, new);
        for i in 0..N {
            (new[self.internal + i], new[self.internal + N + i]) = (gradients[i], forces[i]);
        }
        (new[self.internal + 2 * N], new[self.internal + 2 * N + 1]) = (stored, dissipated);
        if !new.iter().chain(tangent.as_flattened()).all(|x| x.is_finite()) {
            return Err(UpdateFailure::Law("the external behaviour gives a number that is not finite"));
        }
        let branch = if inelastic { INELASTIC } else { UpdateBranch::ELASTIC };
        Ok(Step { forces, tangent, branch, stored, dissipated: lost })
    }

    /// Calls the library; returns the buffers of the end of the step.
    fn call(
        &self,
        buffers: &mut Buffers,
        gradients: &[f64],
        time_step: f64,
        before: &[f64],
        (own, from, energies): (&[f64], &[f64], &[f64]),
    ) -> Result<End, &'static str> {
        let mut request = [0.0; LARGEST * LARGEST];
        request[0] = CONSISTENT_TANGENT;
        let message = buffers.write(&[0.0; MESSAGE / size_of::<f64>()]);
        let [factor, speed] = [1.0, 0.0].map(|number| buffers.write(&[number]));
        let [density, properties] = [&[self.density][..], &self.properties].map(|numbers| buffers.read(numbers));
        let external = buffers.read(&self.external);
        let [from_gradients, from_forces, from_internal] = [before, from, own].map(|numbers| buffers.read(numbers));
        let [from_stored, from_dissipated] = [0, 1].map(|i| buffers.read(&energies[i..=i]));
        let to_gradients = buffers.read(gradients);
        let end = End {
            tangent: buffers.write(&request),
            forces: buffers.write(from),
            internal: buffers.write(own),
            stored: buffers.write(&energies[..1]),
            dissipated: buffers.write(&energies[1..2]),
        };
        let mut at = |buffer: &Buffer| buffers.pointer(buffer);
        let mut data = BehaviourData {
            error_message: at(&message).cast(),
            time_step,
            tangent: at(&end.tangent),
            time_step_factor: at(&factor),
            speed_of_sound: at(&speed),
            start: State {
                gradients: at(&from_gradients),
                forces: at(&from_forces),
                mass_density: at(&density),
                material_properties: at(&properties),
                internal_variables: at(&from_internal),
                stored_energy: at(&from_stored),
                dissipated_energy: at(&from_dissipated),
                external_variables: at(&external),
            },
            end: State {
                gradients: at(&to_gradients),
                forces: at(&end.forces),
                mass_density: at(&density),
                material_properties: at(&properties),
                internal_variables: at(&end.internal),
                stored_energy: at(&end.stored),
                dissipated_energy: at(&end.dissipated),
                external_variables: at(&external),
            },
        };
        // SAFETY: every pointer refers to as many numbers as the description of the library gives (`load`). They live
        // until after the call, in memory of this call only. By its interface the library reads the start and writes
        // the end of the step.
        let code = unsafe { (self.integrate)(&raw mut data) };
        if let Some(why) = buffers.misused() {
            return Err(why);
        }
        if code == 1 { Ok(end) } else { Err(refusal(code, buffers.numbers(&message))) }
    }

    /// Returns true if the behaviour's own state shows an irreversible change: any number of it changed, except that
    /// the elastic strain may follow the strain, within rounding.
    fn inelastic(&self, before: &[f64], gradients: &[f64], old: &[f64], new: &[f64]) -> bool {
        let strain = self.elastic_strain.map_or(0..0, |start| start..start + before.len());
        let size = before.iter().chain(gradients).fold(0.0_f64, |size, x| size.max(x.abs()));
        let follows = |(i, place): (usize, usize)| {
            let behind = new[place] - old[place] - (gradients[i] - before[i]);
            behind.abs() <= 1e-12 * size
        };
        let mut others = (0..self.internal).filter(|place| !strain.contains(place));
        others.any(|place| new[place] != old[place]) || !strain.clone().enumerate().all(follows)
    }
}

/// Returns the reason why a step was refused; `message` holds the characters that the library wrote, up to the first
/// zero.
fn refusal(code: i32, message_numbers: &[f64]) -> &'static str {
    let bytes: Vec<u8> =
        message_numbers.iter().flat_map(|eight| eight.to_ne_bytes()).take_while(|byte| *byte != 0).collect();
    let said = String::from_utf8_lossy(&bytes).replace(|c: char| c.is_control(), " ");
    match (code, said.is_empty()) {
        (0, true) => "the external behaviour calls its result unreliable",
        (_, true) => "the external behaviour could not integrate the step",
        (0, false) => message(&format!("the external behaviour calls its result unreliable: {said}")),
        (_, false) => message(&format!("the external behaviour could not integrate the step: {said}")),
    }
}

fn missing(symbol: &str) -> Wrong {
    vec![(
        "library".into(),
        format!("the library does not say its {symbol}: it is no library of MFront's generic interface"),
    )]
}

/// Returns true if the behaviour reports its energies. An error if they are of another kind.
fn check_family(symbols: &Symbols, request: &Request, family: &Family) -> Result<bool, Wrong> {
    let name = request.behaviour;
    if symbols.text("mfront_ept").is_none() || symbols.number("mfront_mkt") != Some(1) {
        return wrong("behaviour", format!("the library has no behaviour called {name}"));
    }
    match symbols.text("mfront_interface").as_deref() {
        Some("Generic") => {}
        other => {
            let found = other.unwrap_or("an unknown one");
            return wrong("behaviour", format!("{name} is compiled for the interface {found}, not for Generic"));
        }
    }
    let version = symbols.number("api_version").unwrap_or(0);
    if version != API_VERSION {
        return wrong(
            "behaviour",
            format!(
                "{name} has version {version} of the generic interface; version {API_VERSION} is read (TFEL 4 and later)"
            ),
        );
    }
    if let Some(units) = symbols.text("unit_system").filter(|units| !units.is_empty() && units != "SI") {
        return wrong("behaviour", format!("{name} counts in the units {units}, not in SI"));
    }
    let kind = [symbols.number("BehaviourType"), symbols.number("BehaviourKinematic")];
    if kind != family.kind.map(Some) {
        return wrong("behaviour", format!("{name} is no {}", family.words));
    }
    let hypotheses = symbols.names("ModellingHypotheses").ok_or_else(|| missing("ModellingHypotheses"))?;
    if !hypotheses.iter().any(|own| own == family.hypothesis) {
        return wrong(
            "behaviour",
            format!("{name} is not compiled for {}, only for {}", family.hypothesis, hypotheses.join(", ")),
        );
    }
    if symbols.number("SymmetryType").unwrap_or(0) != 0 || symbols.number("ElasticSymmetryType").unwrap_or(0) != 0 {
        return wrong("behaviour", format!("{name} is orthotropic, which is not read"));
    }
    if symbols.number("requiresThermalExpansionCoefficientTensor") == Some(1) {
        return wrong("behaviour", format!("{name} expands with temperature, which is not read"));
    }
    for (list, expected) in ["Gradients", "ThermodynamicForces"].iter().zip(family.names) {
        if symbols.names(list).is_none_or(|own| own != [expected]) {
            return wrong("behaviour", format!("{name} has other {list} than {expected}"));
        }
    }
    let says = |symbol| symbols.number(symbol) == Some(1);
    Ok(says("ComputesInternalEnergy") && says("ComputesDissipatedEnergy"))
}

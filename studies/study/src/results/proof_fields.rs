//! Forces and velocities that prove an answer. In results.json, scenes in the plane and in space have the same keys: a force
//! has two components or three, a velocity three or six.

use super::entries::{FieldEntry, FillEntry, MotionEntry};
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::fmt;

/// Forces and velocities that prove an answer.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(into = "StoredProof", try_from = "StoredProof")]
pub struct ProofFields {
    /// The factor at which `field` is in equilibrium.
    pub field_factor: Option<f64>,
    /// Contact forces.
    pub field: Option<Vec<FieldEntry>>,
    /// Forces of the fill that belong to `field`, if the fill resists.
    pub fill: Vec<FillEntry>,
    /// Velocities of the mechanism.
    pub motion: Option<Vec<MotionEntry>>,
    /// Velocities of the mechanism that proves `associated_load_factor`.
    pub associated_motion: Option<Vec<MotionEntry>>,
    /// For `unbounded`: contact forces that balance the live load alone. Empty for supports that blocks cannot follow.
    pub ray: Option<Vec<FieldEntry>>,
    /// On arches: the point where the resultant crosses each joint \[m\]; `null` if a joint is not loaded.
    pub thrust_line: Option<Vec<Option<[f64; 2]>>>,
    /// Forces and velocities in space; `None` in plane scenes.
    pub space: Option<Box<SpaceProof>>,
}

/// Forces and velocities of a scene in space.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SpaceProof {
    /// Contact forces.
    pub field: Option<Vec<SpaceFieldEntry>>,
    /// Velocities of the mechanism; in a stage that stands after a settlement, displacements \[m, rad\].
    pub motion: Option<Vec<SpaceMotionEntry>>,
    /// Velocities of the mechanism that proves `associated_load_factor`.
    pub associated_motion: Option<Vec<SpaceMotionEntry>>,
    /// For `unbounded`: contact forces that balance the live load alone.
    pub ray: Option<Vec<SpaceFieldEntry>>,
}

/// A contact force at a point of a contact in space \[N\].
#[derive(Debug, Clone, PartialEq)]
pub struct SpaceFieldEntry {
    /// Index of the contact.
    pub joint: usize,
    /// Point of application \[m\].
    pub point: [f64; 3],
    /// \[r_n, r_s, r_t\] on the plus body.
    pub force: [f64; 3],
}

/// Velocity of a body in space.
#[derive(Debug, Clone, PartialEq)]
pub struct SpaceMotionEntry {
    /// Name of the body.
    pub body: String,
    /// \[v_x, v_y, v_z, ω_x, ω_y, ω_z\] at its centroid.
    pub velocity: [f64; 6],
}

/// Up to six numbers, without an allocation.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Numbers {
    count: usize,
    values: [f64; 6],
}

impl Numbers {
    fn of<const N: usize>(numbers: [f64; N]) -> Self {
        let mut values = [0.0; 6];
        values[..N].copy_from_slice(&numbers);
        Numbers { count: N, values }
    }

    fn exactly<const N: usize>(&self, what: &str) -> Result<[f64; N], String> {
        let found = self.values[..self.count].try_into();
        found.map_err(|_| format!("{what} has {} numbers, and another entry has {N}", self.count))
    }
}

impl Serialize for Numbers {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.values[..self.count].serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Numbers {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Up;
        impl<'de> Visitor<'de> for Up {
            type Value = Numbers;

            fn expecting(&self, out: &mut fmt::Formatter) -> fmt::Result {
                out.write_str("a list of 2 numbers in the plane or 3 in space; for a velocity, of 3 or 6")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Numbers, A::Error> {
                let mut numbers = Numbers { count: 0, values: [0.0; 6] };
                while let Some(number) = list.next_element()? {
                    let place = numbers.values.get_mut(numbers.count);
                    *place.ok_or_else(|| A::Error::invalid_length(7, &self))? = number;
                    numbers.count += 1;
                }
                let fits = matches!(numbers.count, 2 | 3 | 6);
                if fits { Ok(numbers) } else { Err(A::Error::invalid_length(numbers.count, &self)) }
            }
        }
        deserializer.deserialize_seq(Up)
    }
}

#[derive(Clone, Serialize, Deserialize)]
struct StoredForce {
    joint: usize,
    point: Numbers,
    force: Numbers,
}

#[derive(Clone, Serialize, Deserialize)]
struct StoredVelocity {
    body: String,
    velocity: Numbers,
}

/// The form in results.json.
#[derive(Clone, Serialize, Deserialize)]
struct StoredProof {
    field_factor: Option<f64>,
    field: Option<Vec<StoredForce>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    fill: Vec<FillEntry>,
    motion: Option<Vec<StoredVelocity>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    associated_motion: Option<Vec<StoredVelocity>>,
    ray: Option<Vec<StoredForce>>,
    thrust_line: Option<Vec<Option<[f64; 2]>>>,
}

impl StoredForce {
    fn of<const N: usize>(joint: usize, point: [f64; N], force: [f64; N]) -> Self {
        StoredForce { joint, point: Numbers::of(point), force: Numbers::of(force) }
    }

    /// Returns joint, point and force with this number of components.
    fn parts<const N: usize>(self) -> Result<(usize, [f64; N], [f64; N]), String> {
        Ok((self.joint, self.point.exactly("point")?, self.force.exactly("force")?))
    }
}

impl StoredVelocity {
    fn of<const N: usize>(body: String, velocity: [f64; N]) -> Self {
        StoredVelocity { body, velocity: Numbers::of(velocity) }
    }

    /// Returns body and velocity with this number of components.
    fn parts<const N: usize>(self) -> Result<(String, [f64; N]), String> {
        Ok((self.body, self.velocity.exactly("velocity")?))
    }
}

/// Converts each entry of a list, if there is a list.
fn each<S, T>(list: Option<Vec<S>>, one: impl Fn(S) -> T) -> Option<Vec<T>> {
    list.map(|list| list.into_iter().map(one).collect())
}

/// Reads each entry of a list, if there is a list.
fn read<S, T>(list: Option<Vec<S>>, one: impl Fn(S) -> Result<T, String>) -> Result<Option<Vec<T>>, String> {
    list.map(|list| list.into_iter().map(one).collect()).transpose()
}

impl From<ProofFields> for StoredProof {
    fn from(proof: ProofFields) -> Self {
        let ProofFields { field_factor, field, fill, motion, associated_motion, ray, thrust_line, space } = proof;
        let (field, motion, associated_motion, ray) = match space {
            None => {
                let force = |own: FieldEntry| StoredForce::of(own.joint, own.point, own.force);
                let velocity = |own: MotionEntry| StoredVelocity::of(own.body, own.velocity);
                (each(field, force), each(motion, velocity), each(associated_motion, velocity), each(ray, force))
            }
            Some(space) => {
                let force = |own: SpaceFieldEntry| StoredForce::of(own.joint, own.point, own.force);
                let velocity = |own: SpaceMotionEntry| StoredVelocity::of(own.body, own.velocity);
                let associated = each(space.associated_motion, velocity);
                (each(space.field, force), each(space.motion, velocity), associated, each(space.ray, force))
            }
        };
        StoredProof { field_factor, field, fill, motion, associated_motion, ray, thrust_line }
    }
}

impl TryFrom<StoredProof> for ProofFields {
    type Error = String;

    fn try_from(stored: StoredProof) -> Result<Self, String> {
        let StoredProof { field_factor, field, fill, motion, associated_motion, ray, thrust_line } = stored;
        let forces = field.iter().chain(&ray).flatten().any(|entry| entry.force.count == 3);
        let in_space =
            forces || motion.iter().chain(&associated_motion).flatten().any(|entry| entry.velocity.count == 6);
        let plane = ProofFields { field_factor, fill, thrust_line, ..ProofFields::default() };
        if in_space {
            let force =
                |own: StoredForce| own.parts().map(|(joint, point, force)| SpaceFieldEntry { joint, point, force });
            let velocity =
                |own: StoredVelocity| own.parts().map(|(body, velocity)| SpaceMotionEntry { body, velocity });
            let (field, motion, ray) = (read(field, force)?, read(motion, velocity)?, read(ray, force)?);
            let associated_motion = read(associated_motion, velocity)?;
            return Ok(ProofFields {
                space: Some(Box::new(SpaceProof { field, motion, associated_motion, ray })),
                ..plane
            });
        }
        let force = |own: StoredForce| own.parts().map(|(joint, point, force)| FieldEntry { joint, point, force });
        let velocity = |own: StoredVelocity| own.parts().map(|(body, velocity)| MotionEntry { body, velocity });
        let (field, motion, ray) = (read(field, force)?, read(motion, velocity)?, read(ray, force)?);
        let associated_motion = read(associated_motion, velocity)?;
        Ok(ProofFields { field, motion, associated_motion, ray, ..plane })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn space() -> ProofFields {
        let force = SpaceFieldEntry { joint: 3, point: [1.0, 2.0, 3.0], force: [4.0, 5.0, 6.0] };
        let motion = SpaceMotionEntry { body: "b".into(), velocity: [1.0, 2.0, 3.0, 4.0, 5.0, 6.0] };
        let space = SpaceProof {
            field: Some(vec![force]),
            motion: Some(vec![motion.clone()]),
            associated_motion: Some(vec![motion]),
            ray: None,
        };
        ProofFields { field_factor: Some(0.5), space: Some(Box::new(space)), ..ProofFields::default() }
    }

    /// Forces and velocities in the plane and in space are read back as they were, under the same keys.
    #[test]
    fn plane_and_space_share_keys() {
        let force = FieldEntry { joint: 3, point: [1.0, 2.0], force: [4.0, 5.0] };
        let motion = MotionEntry { body: "b".into(), velocity: [1.0, 2.0, 3.0] };
        let plane = ProofFields { field: Some(vec![force]), motion: Some(vec![motion]), ..ProofFields::default() };
        for proof in [plane, space(), ProofFields::default()] {
            let text = serde_json::to_string(&proof).expect("it is written");
            assert_eq!(serde_json::from_str::<ProofFields>(&text).expect("it is read"), proof);
            assert!(text.contains("\"field\":") && text.contains("\"motion\":"));
        }
    }

    /// Forces in the plane beside forces in space are a mistake, and so is a force with four components.
    #[test]
    fn components_must_agree() {
        let mixed = serde_json::to_string(&space()).expect("it is written").replace("[4.0,5.0,6.0]", "[4.0,5.0]");
        let why = serde_json::from_str::<ProofFields>(&mixed).expect_err("it is mixed").to_string();
        assert!(why.contains("force has 2 numbers, and another entry has 3"), "{why}");
        let long = mixed.replace("[4.0,5.0]", "[4.0,5.0,6.0,7.0]");
        assert!(serde_json::from_str::<ProofFields>(&long).is_err());
    }
}

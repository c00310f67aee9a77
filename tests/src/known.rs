//! Problems with known answers, for tests and benches: closed forms, independent programs, published numbers. Factors
//! are dimensionless or in kN.

use crate::{Arch, Wall};

/// The reference arch ([`Arch::default`]): rise 2.99 m, bonded ends, friction 0.6, load above quarter span. Value of
/// two independent programs.
pub const REFERENCE_ARCH: f64 = 698.022_665_212_378_8;

/// The reference arch with friction 0.3: sliding and hinges together.
pub const REFERENCE_ARCH_LOW_FRICTION: f64 = 517.901_443_003_289_2;

/// The reference arch with 13 voussoirs and jointed ends.
pub const REFERENCE_ARCH_JOINTED: f64 = 491.370_923_687_825_1;

/// [`peers_ring`] with 13 voussoirs: the ring on which all peers were measured.
pub const PEERS_RING: f64 = 84.573_308_72;

/// Returns the reference arch with jointed ends and a width of 1 m.
pub fn peers_ring(voussoirs: usize) -> Arch {
    Arch { voussoirs, ends: "jointed", width: 1.0, ..Arch::default() }
}

/// A wall of Ferris & Tin-Loi (2001), Int. J. Mech. Sci. 43, and Gilbert, Casapulla & Ahmed (2006), Computers &
/// Structures 84: blocks of 0.4 m × 0.175 m, friction 0.65, a horizontal force proportional to weight.
#[derive(Debug, Clone)]
pub struct PublishedWall {
    /// Its number in these papers.
    pub number: usize,
    /// The wall with associated friction; set `joint` for another law.
    pub wall: Wall,
    /// The associated load factor of an independent program; published values .643, .404, .332.
    pub associated: f64,
    /// The least load factor with slip without dilatancy, of an independent program.
    pub least: f64,
    /// The published value for slip without dilatancy.
    pub published: f64,
}

/// A course of five blocks; [`SIX`] is a course of six that begins and ends with a half block.
pub const FIVE: &[f64] = &[1.0; 5];
/// See [`FIVE`].
pub const SIX: &[f64] = &[0.5, 1.0, 1.0, 1.0, 1.0, 0.5];

/// Returns wall 1, 3 (one window) or 4 (two windows).
pub fn published_wall(number: usize) -> PublishedWall {
    let (rows, associated, least, published): (Vec<&[f64]>, _, _, _) = match number {
        1 => (vec![SIX, FIVE, SIX, FIVE, SIX, FIVE], 0.642_859_00, 0.638_981_83, 0.640),
        3 => {
            let (fe, fu): (&[f64], &[f64]) = (&[1.0; 4], &[0.5, 1.0, 1.0, 1.0, 0.5]);
            let (we, wu): (&[f64], &[f64]) = (&[1.0, 0.5, -1.0, 0.5, 1.0], &[0.5, 1.0, -1.0, 1.0, 0.5]);
            (vec![fe, fu, fe, wu, we, wu, we, wu, fe, fu, fe], 0.403_694_10, 0.355_817_38, 0.356)
        }
        4 => {
            let we: &[f64] = &[0.5, 0.5, -1.0, 0.5, 0.5, -1.0, 0.5, 0.5];
            let wu: &[f64] = &[1.0, -1.0, 1.0, -1.0, 1.0];
            (vec![SIX, FIVE, SIX, wu, we, wu, we, wu, SIX, FIVE, SIX], 0.331_948_40, 24.0 / 91.0, 0.264)
        }
        _ => panic!("walls 1, 3 and 4 are published"),
    };
    PublishedWall { number, wall: Wall::of_rows(&rows), associated, least, published }
}

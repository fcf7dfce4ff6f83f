//! From a seed and a kind to a case.

use rand::RngExt;
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;

use crate::ablation::Ablation;
use crate::case::{Case, Conditions, Kind};
use crate::effects::{self, Entry, Hidden, Link, draw_hits};
use crate::error::Error;
use crate::excitation::{COMMAND_PERIOD_S, draw_commands, draw_patterns};
use crate::log::Columns;
use crate::machine::Machine;
use crate::noise::{Stream, stream};
use crate::nuisance::{draw_machine, draw_robot};
use crate::robot::Robot;
use crate::run::Drive;

/// Pairs that look alike in most logs, or nearly cancel.
pub const LOOK_ALIKES: [[&str; 2]; 13] = [
    ["robot-mass", "torque-constant"],
    ["robot-mass", "winding-resistance"],
    ["camera-latency", "wheel-creep"],
    ["wheel-radius-common", "camera-scale"],
    ["wheel-skew", "marker-heading"],
    ["wheel-skew", "wheel-angle"],
    ["encoder-loss", "wheel-radius"],
    ["coulomb-friction", "dead-band"],
    ["viscous-friction", "roller-friction"],
    ["coulomb-friction", "roller-friction"],
    ["battery-sag", "torque-constant"],
    ["camera-scale", "body-radius"],
    ["robot-mass", "yaw-inertia"],
];

/// Effects that the wheels show when nothing but their shafts moves.
const ON_BLOCKS: [&str; 16] = [
    "coulomb-friction",
    "viscous-friction",
    "stribeck-friction",
    "asymmetric-friction",
    "gear-backlash",
    "dead-band",
    "drive-curve",
    "torque-constant",
    "rotor-inertia",
    "actuation-latency",
    "command-latency",
    "pi-gain",
    "quantisation",
    "sample-order",
    "late-sticking",
    "periodic-torque",
];

/// Draws a case of this kind under the usual conditions: 1 kHz, three wheels on the floor, every column.
pub fn draw(seed: u64, kind: &Kind) -> Result<Case, Error> {
    draw_with(seed, kind, &Conditions::default())
}

/// Draws a case of this kind under these conditions; the same arguments give the same case.
pub fn draw_with(seed: u64, kind: &Kind, conditions: &Conditions) -> Result<Case, Error> {
    conditions.check()?;
    let mut robot = draw_robot(conditions, &mut stream(seed, Stream::Robot));
    let mut machine = draw_machine(&robot, &mut stream(seed, Stream::Nuisance));
    if !stream(seed, Stream::Robot).random_bool(0.3) {
        robot.camera_noise = None;
    }
    let mut rng = stream(seed, Stream::Effect);
    let kind = settle(kind, &mut rng);
    let choice = Choice { seed, conditions };
    let (mut effects, mut outside, mut ablation) = (Vec::new(), Vec::new(), None);
    match &kind {
        Kind::EffectFree | Kind::Mixed => {}
        Kind::Axis { .. } => return Err(Error::Conditions("an axis is no robot; `make` writes it".to_owned())),
        Kind::Single { effect, size } => {
            let entry = choice.entry(effect.as_deref(), &mut rng)?;
            effects.push(choice.hide(entry, *size, 1, (&mut machine, &mut robot), &mut rng)?);
        }
        Kind::Pair { effects: named, size } => {
            for entry in choice.pair(named.as_ref(), &mut rng)? {
                effects.push(choice.hide(entry, *size, 2, (&mut machine, &mut robot), &mut rng)?);
            }
        }
        Kind::LookAlike { size } => {
            let fitting: Vec<&[&str; 2]> =
                LOOK_ALIKES.iter().filter(|pair| pair.iter().all(|name| observable_name(name, conditions))).collect();
            let pair = fitting.choose(&mut rng).copied().unwrap_or(&LOOK_ALIKES[0]);
            for name in pair {
                effects.push(choice.hide(effects::find(name)?, *size, 2, (&mut machine, &mut robot), &mut rng)?);
            }
        }
        Kind::Outside { name, size } => {
            let entry = match name {
                Some(name) => effects::find_outside(name)?,
                None => choice.among(effects::outside(), &mut rng)?,
            };
            outside.push(choice.hide(entry, *size, 2, (&mut machine, &mut robot), &mut rng)?);
        }
        Kind::Ablation(which) => {
            let which = which.or_else(|| Ablation::ALL.choose(&mut rng).copied()).unwrap_or(Ablation::AbsentTruth);
            effects.push(choice.ablate(which, (&mut machine, &mut robot), &mut rng)?);
            ablation = Some(which);
        }
    }
    let drives = draw_drives(seed, conditions, &machine);
    Ok(Case {
        seed,
        kind,
        conditions: conditions.clone(),
        columns: Columns {
            commands: conditions.commands,
            duty: conditions.duty,
            camera: conditions.camera && !conditions.blocks,
            supply: true,
            inertial: conditions.inertial,
        },
        robot,
        machine,
        drives,
        effects,
        outside,
        ablation,
    })
}

/// Replaces `Mixed` by one of the others.
fn settle(kind: &Kind, rng: &mut ChaCha8Rng) -> Kind {
    if *kind != Kind::Mixed {
        return kind.clone();
    }
    match rng.random_range(0..100) {
        0..25 => Kind::EffectFree,
        25..70 => Kind::Single { effect: None, size: None },
        70..80 => Kind::Pair { effects: None, size: None },
        80..86 => Kind::LookAlike { size: None },
        86..95 => Kind::Outside { name: None, size: None },
        _ => Kind::Ablation(None),
    }
}

/// What an effect's choice depends on.
struct Choice<'a> {
    seed: u64,
    conditions: &'a Conditions,
}

impl Choice<'_> {
    /// The named entry, or one that shows under these conditions.
    fn entry(&self, name: Option<&str>, rng: &mut ChaCha8Rng) -> Result<&'static Entry, Error> {
        if let Some(name) = name {
            return effects::find(name);
        }
        self.among(effects::catalogue(), rng)
    }

    /// One of these entries that shows under these conditions.
    fn among(
        &self,
        entries: impl Iterator<Item = &'static Entry>,
        rng: &mut ChaCha8Rng,
    ) -> Result<&'static Entry, Error> {
        let fitting: Vec<&Entry> = entries.filter(|entry| observable(entry, self.conditions)).collect();
        fitting
            .choose(rng)
            .copied()
            .ok_or_else(|| Error::Conditions("no effect of this kind shows under them".to_owned()))
    }

    /// Two different entries; two drawn ones never contain a wrong wheel order, which hides everything else.
    fn pair(&self, named: Option<&[String; 2]>, rng: &mut ChaCha8Rng) -> Result<[&'static Entry; 2], Error> {
        if let Some([a, b]) = named {
            return Ok([effects::find(a)?, effects::find(b)?]);
        }
        let mut draw = |other: Option<&str>| loop {
            match self.entry(None, rng) {
                Ok(entry) if entry.name != "wheel-order" && Some(entry.name) != other => return Ok(entry),
                Ok(_) => {}
                Err(error) => return Err(error),
            }
        };
        let first = draw(None)?;
        Ok([first, draw(Some(first.name))?])
    }

    /// Hides the entry at this size, or at one drawn from `least` to 5.
    fn hide(
        &self,
        entry: &Entry,
        size: Option<u8>,
        least: u8,
        (machine, robot): (&mut Machine, &mut Robot),
        rng: &mut ChaCha8Rng,
    ) -> Result<Hidden, Error> {
        let level = size.unwrap_or_else(|| rng.random_range(least..=5));
        effects::hide(entry, level, self.seed, machine, robot)
    }

    /// The effect that an ablated case claims.
    fn ablate(
        &self,
        which: Ablation,
        (machine, robot): (&mut Machine, &mut Robot),
        rng: &mut ChaCha8Rng,
    ) -> Result<Hidden, Error> {
        let name = match which {
            Ablation::ShuffledCamera => ["camera-latency", "wheel-skew", "wheel-radius", "marker-offset"].choose(rng),
            Ablation::SwappedLabels => ["wheel-radius", "wheel-angle", "encoder-loss"].choose(rng),
            Ablation::AbsentTruth => ["wheel-skew", "wheel-radius", "torque-constant", "viscous-friction"].choose(rng),
        };
        let entry = effects::find(name.copied().unwrap_or("wheel-radius"))?;
        let mut untouched = machine.clone();
        let target = if which == Ablation::AbsentTruth { &mut untouched } else { machine };
        self.hide(entry, None, 3, (target, robot), rng)
    }
}

/// Whether an effect can show in the logs made under these conditions.
#[must_use]
pub fn observable(entry: &Entry, conditions: &Conditions) -> bool {
    let seen = match entry.link {
        Link::Motion | Link::Timing => conditions.camera && !conditions.blocks,
        Link::Drive | Link::Controller => conditions.duty,
        Link::Command => conditions.commands,
    };
    seen && (!conditions.blocks || ON_BLOCKS.contains(&entry.name))
}

fn observable_name(name: &str, conditions: &Conditions) -> bool {
    effects::find(name).is_ok_and(|entry| observable(entry, conditions))
}

/// The runs of a case: they depend on seed and conditions, not on what is hidden (collisions excepted).
fn draw_drives(seed: u64, conditions: &Conditions, machine: &Machine) -> Vec<Drive> {
    let mut rng = stream(seed, Stream::Excitation);
    let patterns = draw_patterns(&mut rng, conditions.translations_only);
    let mut drives: Vec<Drive> = patterns
        .into_iter()
        .map(|pattern| {
            let commands = draw_commands(pattern, conditions.translations_only, &mut rng);
            let start = [
                rng.random_range(-0.7..0.7),
                rng.random_range(-0.7..0.7),
                rng.random_range(-std::f64::consts::PI..std::f64::consts::PI),
            ];
            Drive { name: pattern.name().to_owned(), commands, period_s: COMMAND_PERIOD_S, start, hits: Vec::new() }
        })
        .collect();
    for drive in &mut drives {
        drive.hits = draw_hits(&machine.disturbances, drive.seconds(), &mut rng);
    }
    drives
}

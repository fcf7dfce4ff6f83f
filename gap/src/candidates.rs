//! What a link is searched for: every form of every effect that can act there.

use std::sync::Arc;

use crate::state::{Active, State};
use links::effect::{Effect, Link, Sizes};

/// The link's candidates: every form of every effect fitted there.
pub fn candidates(state: &State, catalogue: &[Arc<dyn Effect>], link: Link) -> Vec<Active> {
    candidates_in(state, catalogue, link, &Sizes::of(&state.robot))
}

/// The same for logs of these sizes.
pub fn candidates_in(state: &State, catalogue: &[Arc<dyn Effect>], link: Link, sizes: &Sizes) -> Vec<Active> {
    let acts = |e: &dyn Effect| e.link() == link || e.also() == Some(link);
    candidates_of(state, catalogue, link, sizes, acts)
}

/// Effects beside which another is not looked for: creep is slip below the limit of friction, and one law of the contact is
/// named; a filter beside late counts is another delay.
const BESIDE: [(&str, &str); 2] = [("wheel-slip", "wheel-creep"), ("encoder-lag", "speed-filter")];

/// Effects that do all that another one does, so that both are never named: clocks of single runs may all be late together.
const DOES_ALL: [(&str, &str); 1] = [("camera-clock", "camera-latency")];

/// Whether an effect does all that another one does, in each of its forms.
pub(crate) fn does_all(one: &Active, other: &Active) -> bool {
    DOES_ALL.contains(&(one.effect.name(), other.effect.name()))
}

/// Every form of the effects that act, each to be fitted on a link; of those only that the robot can have.
pub fn candidates_of(
    state: &State,
    catalogue: &[Arc<dyn Effect>],
    link: Link,
    sizes: &Sizes,
    acts: impl Fn(&dyn Effect) -> bool,
) -> Vec<Active> {
    let there = |name: &str| state.active.iter().any(|a| a.effect.name() == name);
    let wanted = catalogue.iter().filter(|e| {
        let stood_for = BESIDE.iter().any(|(beside, name)| e.name() == *name && there(beside));
        acts(e.as_ref()) && !there(e.name()) && !stood_for && links::effects::fits(e.name(), &state.robot)
    });
    wanted
        .flat_map(|e| e.forms_in(&state.robot, sizes).into_iter().map(|f| Active { link, ..Active::new(e.clone(), f) }))
        .collect()
}

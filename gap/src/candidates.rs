//! What a link is searched for: every form of every effect that can act there.

use std::sync::Arc;

use crate::effect::{Effect, Link, Sizes};
use crate::state::{Active, State};

/// The link's candidates: every form of every effect fitted there.
pub fn candidates(state: &State, catalogue: &[Arc<dyn Effect>], link: Link) -> Vec<Active> {
    candidates_in(state, catalogue, link, &Sizes::of(&state.robot))
}

/// The same for logs of these sizes.
pub fn candidates_in(state: &State, catalogue: &[Arc<dyn Effect>], link: Link, sizes: &Sizes) -> Vec<Active> {
    let wanted = catalogue.iter().filter(|e| {
        (e.link() == link || e.also() == Some(link)) && !state.active.iter().any(|a| a.effect.name() == e.name())
            // Creep is slip below the limit of friction: one law of the contact is named.
            && !(e.name() == "wheel-creep" && state.active.iter().any(|a| a.effect.name() == "wheel-slip"))
            && crate::effects::fits(e.name(), &state.robot)
    });
    wanted
        .flat_map(|e| e.forms_in(&state.robot, sizes).into_iter().map(|f| Active { link, ..Active::new(e.clone(), f) }))
        .collect()
}

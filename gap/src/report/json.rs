//! `gap.json`.

use serde_json::{Map, Value, json};

use crate::analysis::{Analysis, Named, overall};
use crate::evidence::Interval;

/// Effects whose parameter the contract knows without a wheel's number: of one wheel alone it stands under both names.
const NUMBERLESS: [&str; 2] = ["gear-backlash", "viscous-friction"];

/// `play_rad` for `play_2_rad` of wheel 2 alone.
fn plain_name(effect: &Named, parameter: &str) -> Option<String> {
    let [wheel] = effect.wheels[..] else { return None };
    let number = format!("_{wheel}_");
    (NUMBERLESS.contains(&effect.name.as_str()) && parameter.contains(&number))
        .then(|| parameter.replacen(&number, "_", 1))
}

/// What cannot be told apart, the effects that share what a named one does among them.
fn ties(a: &Analysis) -> Vec<Vec<String>> {
    let shared =
        a.effects.iter().flat_map(|e| e.conditional_on.iter().map(|other| vec![e.name.clone(), other.clone()]));
    a.alternatives.iter().cloned().chain(shared).collect()
}

pub(super) fn json(a: &Analysis) -> Value {
    let (before, after) = overall(&a.links);
    let named = !a.effects.is_empty();
    let closed = if named && before > 1.0 { json!(((before - after) / (before - 1.0)).min(1.0)) } else { Value::Null };
    let parameters = |e: &Named| {
        let entry = |name: String, v: &f64, known: &Interval| (name, known.to_json(*v));
        let own = e.parameters.iter().map(|(n, v, ci)| entry(n.clone(), v, ci));
        let plain = e.parameters.iter().filter_map(|(n, v, ci)| Some(entry(plain_name(e, n)?, v, ci)));
        Value::Object(own.chain(plain).collect::<Map<String, Value>>())
    };
    let links: Map<String, Value> = a
        .links
        .iter()
        .map(|l| {
            let signals: Vec<Value> = l
                .rms
                .iter()
                .zip(&l.units)
                .zip(&l.floor)
                .map(|((rms, unit), floor)| json!({"before": rms[0], "after": rms[1], "floor": floor, "unit": unit}))
                .collect();
            (l.link.name().to_owned(), json!({"before": l.before, "after": l.after, "floor": 1.0, "signals": signals}))
        })
        .collect();
    json!({
        "verdict": a.verdict.name(),
        "set_up_mistakes": a.mistakes,
        "located": a.located.iter().map(|l| json!({
            "link": l.link.name(), "signal": l.signal, "excess": l.excess, "where": l.place,
        })).collect::<Vec<_>>(),
        "effects": a.effects.iter().map(|e| json!({
            "name": e.name, "wheels": e.wheels, "parameters": parameters(e),
            "gain": e.gain, "p_value": e.evidence.p_value(), "evidence": e.evidence.to_json(), "link": e.link.name(), "equation": e.equation,
            "conditional_on": e.conditional_on,
        })).collect::<Vec<_>>(),
        "alternatives": ties(a),
        "unexplained": a.unexplained.iter().map(|u| json!({"link": u.link.name(), "structure": u.structure})).collect::<Vec<_>>(),
        "next_experiment": a.next_experiment.as_ref().map(|e| json!({
            "kind": e.kind, "what": e.what, "separates": e.separates, "seconds": e.seconds, "times": e.times,
            "sigmas": e.sigmas, "why": e.why,
            "others": e.others.iter().map(|(what, seconds)| json!({"what": what, "seconds": seconds})).collect::<Vec<_>>(),
        })),
        "gap": {
            "before": before, "after": after, "floor": 1.0, "closed": closed, "links": links,
            "of": "the written robot.toml, read again, on every run; nothing is fitted but what it declares the recording's own",
            "held_out": a.held_out.iter().map(|(link, rms)| (link.name().to_owned(), json!(rms))).collect::<Map<String, Value>>(),
        },
        "remains": a.remains,
        "nearest": a.nearest,
        "detection_limits": a.limits.iter().map(|l| json!({
            "name": l.name, "parameter": l.parameter, "limit": l.limit, "material": l.material,
            "estimate": l.estimate, "sd": l.sd,
        })).collect::<Vec<_>>(),
        "waterfall": a.waterfall.iter().map(|(n, v)| json!({"step": n, "gap": v})).collect::<Vec<_>>(),
        "thresholds": a.thresholds.stated().into_iter().map(|s| {
            let values = if let [value] = s.values[..] { json!(value) } else { json!(s.values) };
            (s.name.to_owned(), values)
        }).collect::<Map<String, Value>>(),
        "split": if a.runs.len() > 1 { "leave one run out" } else { "blocks of the single run" },
        "runs": a.runs,
        "replayed": a.exact.iter().filter_map(|l| Some((l.link, l.replay.as_ref()?))).map(|(link, r)| {
            let counts = json!({
                "words": r.compared, "different": r.different, "gaps": r.gaps, "missing_ticks": r.missing,
            });
            (link.name().to_owned(), counts)
        }).collect::<Map<String, Value>>(),
        "remarks": a.remarks,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use links::effect::Link;

    #[test]
    fn a_wheel_alone_has_the_plain_name_too() {
        let named = |name: &str, wheels: &[usize]| Named::bare(name, Link::Drive, wheels);
        assert_eq!(plain_name(&named("gear-backlash", &[2]), "play_2_rad").as_deref(), Some("play_rad"));
        assert_eq!(plain_name(&named("gear-backlash", &[1, 2]), "play_2_rad"), None);
        assert_eq!(plain_name(&named("wheel-radius", &[2]), "scale_2"), None);
    }
}

//! `gap.json`.

use serde_json::{Map, Value, json};

use crate::analysis::{Analysis, overall};

pub(super) fn json(a: &Analysis) -> Value {
    let (before, after) = overall(&a.links);
    let named = !a.effects.is_empty();
    let closed = if named && before > 1.0 { json!(((before - after) / (before - 1.0)).min(1.0)) } else { Value::Null };
    let parameters = |list: &[(String, f64, [f64; 2])]| {
        let entries = list.iter().map(|(n, v, ci)| (n.clone(), json!({"value": v, "ci95": ci})));
        Value::Object(entries.collect::<Map<String, Value>>())
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
        "located": a.located.iter().map(|l| json!({
            "link": l.link.name(), "signal": l.signal, "excess": l.excess, "where": l.place,
        })).collect::<Vec<_>>(),
        "effects": a.effects.iter().map(|e| json!({
            "name": e.name, "wheels": e.wheels, "parameters": parameters(&e.parameters),
            "gain": e.gain, "p_value": e.p_value, "link": e.link.name(), "equation": e.equation,
        })).collect::<Vec<_>>(),
        "alternatives": a.alternatives,
        "unexplained": a.unexplained.iter().map(|u| json!({"link": u.link.name(), "structure": u.structure})).collect::<Vec<_>>(),
        "next_experiment": a.next_experiment.as_ref().map(|e| json!({
            "kind": e.kind, "what": e.what, "separates": e.separates, "seconds": e.seconds, "times": e.times,
            "sigmas": e.sigmas, "why": e.why,
            "others": e.others.iter().map(|(what, seconds)| json!({"what": what, "seconds": seconds})).collect::<Vec<_>>(),
        })),
        "gap": {"before": before, "after": after, "floor": 1.0, "closed": closed, "links": links},
        "nearest": a.nearest,
        "detection_limits": a.limits.iter().map(|l| json!({
            "name": l.name, "parameter": l.parameter, "limit": l.limit, "material": l.material,
            "estimate": l.estimate, "sd": l.sd,
        })).collect::<Vec<_>>(),
        "waterfall": a.waterfall.iter().map(|(n, v)| json!({"step": n, "gap": v})).collect::<Vec<_>>(),
        "thresholds": {
            "held_share_of_materiality": a.thresholds.held_share,
            "objective_gain": a.thresholds.gain,
            "cost_per_effect": a.thresholds.costs[0],
            "cost_per_further_parameter": a.thresholds.costs[1],
            "held_out_share": {"motion": a.thresholds.shares[0], "drive": a.thresholds.shares[1]},
            "held_out_share_of_excess": a.thresholds.share_of_excess,
            "held_out_t": a.thresholds.held_out_t,
            "split": if a.runs.len() > 1 { "leave one run out" } else { "blocks of the single run" },
        },
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

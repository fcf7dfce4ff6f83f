//! Timing diagrams of the local bus as WaveJSON (wavedrom.com), played by the bit-true twin: what they
//! show is what happens.

use fixed_kin::local_bus::{Inputs, LocalBus};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// One cycle of a master.
#[derive(Clone, Copy, Debug)]
struct Scene {
    title: &'static str,
    write: bool,
    words: u32,
    /// Clocks in which the core cannot take a write.
    busy: usize,
}

const SCENES: [Scene; 4] = [
    Scene { title: "single read", write: false, words: 1, busy: 0 },
    Scene { title: "single write", write: true, words: 1, busy: 0 },
    Scene { title: "burst read of two words", write: false, words: 2, busy: 0 },
    Scene { title: "write, the core is busy for two clocks", write: true, words: 1, busy: 2 },
];

/// Levels or labels of a signal, clock by clock, as WaveJSON writes them.
#[derive(Default)]
struct Wave {
    wave: String,
    data: Vec<String>,
    shown: Option<String>,
}

impl Wave {
    /// A level (`0`, `1`, `z`) or, if longer, a label.
    fn push(&mut self, value: &str) {
        if self.shown.as_deref() == Some(value) {
            self.wave.push('.');
        } else if matches!(value, "0" | "1" | "z") {
            self.wave.push_str(value);
        } else {
            self.wave.push('=');
            self.data.push(value.to_owned());
        }
        self.shown = Some(value.to_owned());
    }

    fn level(&mut self, high: bool) {
        self.push(if high { "1" } else { "0" });
    }

    fn named(self, name: &str) -> Value {
        if self.data.is_empty() {
            json!({"name": name, "wave": self.wave})
        } else {
            json!({"name": name, "wave": self.wave, "data": self.data})
        }
    }
}

fn play(scene: Scene) -> Value {
    let mut block = LocalBus::new();
    let mut waves: [Wave; 7] = Default::default();
    let (mut clock, mut done, mut after) = (0, 0, 0);
    while after < 3 {
        let strobe = clock == 1;
        let data = clock > 1 && done < scene.words;
        let shown = block.outputs(false);
        let busy = scene.write && (3..3 + scene.busy).contains(&clock);
        let inputs = Inputs {
            ads_n: !strobe,
            blast_n: !(data && done + 1 == scene.words),
            lw_r: strobe && scene.write,
            lad: if strobe { 0x7C } else { done },
            read_data: done,
            write_busy: busy,
        };
        let shown = if busy { block.outputs(true) } else { shown };
        let [ads, lw_r, blast, lad, ready, read, write] = &mut waves;
        ads.level(inputs.ads_n);
        lw_r.level(inputs.lw_r);
        blast.level(inputs.blast_n);
        lad.push(&match (strobe, data && scene.write, shown.lad_drive) {
            (true, _, _) => "address".to_owned(),
            (_, true, _) => "data".to_owned(),
            (_, _, true) if !shown.ready_n => format!("word {done}"),
            (_, _, true) => "card".to_owned(),
            _ => "z".to_owned(),
        });
        ready.level(shown.ready_n);
        read.level(shown.read);
        write.level(shown.write);
        done += u32::from(data && !shown.ready_n);
        after += u32::from(done == scene.words);
        block.clock(&inputs);
        clock += 1;
    }
    let names = ["ADS#", "LW/R#", "BLAST#", "LAD", "READY#", "read (inside)", "write (inside)"];
    let mut signals = vec![json!({"name": "LCLK", "wave": format!("p{}", ".".repeat(clock - 1))})];
    signals.extend(waves.into_iter().zip(names).map(|(wave, name)| wave.named(name)));
    json!({"signal": signals, "head": {"text": scene.title}})
}

/// The section of the register document.
#[must_use]
pub fn section() -> String {
    let mut text = String::from(
        "\n## Timing of the local bus\n\n\
         WaveJSON, played by the bit-true twin of the bus block; wavedrom.com draws it. A word is transferred at the \
         rising edge at the end of a clock with READY# low.\n",
    );
    for scene in SCENES {
        let value = play(scene);
        let lines: Vec<_> =
            value["signal"].as_array().into_iter().flatten().map(|signal| format!("    {signal}")).collect();
        let _ = write!(
            text,
            "\n```wavejson\n{{ \"head\": {},\n  \"signal\": [\n{} ] }}\n```\n",
            value["head"],
            lines.join(",\n")
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(scene: &Value, name: &str) -> String {
        let signal = scene["signal"].as_array().unwrap().iter().find(|signal| signal["name"] == name).unwrap();
        signal["wave"].as_str().unwrap().to_owned()
    }

    #[test]
    fn the_diagrams_are_those_of_the_block() {
        let read = play(SCENES[0]);
        assert_eq!(wave(&read, "ADS#"), "101.....");
        assert_eq!(wave(&read, "READY#"), "1....01.");
        let write = play(SCENES[1]);
        assert_eq!(wave(&write, "READY#"), "1...01.");
        assert_eq!(wave(&play(SCENES[3]), "READY#"), "1.....01.");
        assert_eq!(wave(&play(SCENES[2]), "READY#").matches('0').count(), 2);
    }

    #[test]
    fn every_block_of_the_section_is_json() {
        let section = section();
        let blocks: Vec<_> = section.split("```wavejson\n").skip(1).map(|b| b.split("```").next().unwrap()).collect();
        assert_eq!(blocks.len(), SCENES.len());
        for block in blocks {
            serde_json::from_str::<Value>(block).unwrap();
        }
    }
}

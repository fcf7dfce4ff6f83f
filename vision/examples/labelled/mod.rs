//! Photographs with labels beside them: `NAME.jpg` or `NAME.png` and `NAME.txt`, in the text format of Darknet and YOLO.
//!
//! A line is `CLASS X Y WIDTH HEIGHT`, the middle and the sides as shares of the picture's. Class 0 is a ball; whatever else
//! is listed is neither a ball nor a mistake.

#![allow(dead_code, reason = "each example uses a part")]

use std::path::{Path, PathBuf};
use vision::ball::Region;
use vision::picture::{Picture, read};
use vision::render::Label;

/// A picture and what is in it.
pub(crate) struct Photograph {
    /// Where it was read from.
    pub(crate) file: PathBuf,
    /// Its pixels.
    pub(crate) picture: Picture,
    /// Its balls; whatever is to be ignored is a ball of which nothing is visible.
    pub(crate) labels: Vec<Label>,
}

/// All labelled pictures of a folder, by name.
pub(crate) fn folder(folder: &Path) -> Result<Vec<Photograph>, String> {
    let about = |file: &Path, what: &dyn std::fmt::Display| format!("{}: {what}", file.display());
    let entries = std::fs::read_dir(folder).map_err(|error| about(folder, &error))?;
    let mut files: Vec<PathBuf> = entries
        .flatten()
        .map(|entry| entry.path())
        .filter(|file| file.extension().is_some_and(|e| ["png", "jpg", "jpeg"].iter().any(|known| e == *known)))
        .filter(|file| file.with_extension("txt").is_file())
        .collect();
    files.sort();
    let photograph = |file: PathBuf| {
        let picture = read(&file).map_err(|error| about(&file, &error))?;
        let beside = file.with_extension("txt");
        let text = std::fs::read_to_string(&beside).map_err(|error| about(&beside, &error))?;
        let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
        let labels = lines.map(|(number, line)| {
            label(line, &picture)
                .ok_or_else(|| format!("{}:{}: not CLASS X Y WIDTH HEIGHT", beside.display(), number + 1))
        });
        let labels = labels.collect::<Result<_, _>>()?;
        Ok(Photograph { file, picture, labels })
    };
    files.into_iter().map(photograph).collect()
}

fn label(line: &str, picture: &Picture) -> Option<Label> {
    let numbers: Vec<f64> = line.split_whitespace().map(|word| word.parse().ok()).collect::<Option<_>>()?;
    let [class, x, y, width, height] = numbers[..] else { return None };
    let (across, down) = (picture.width() as f64, picture.height() as f64);
    let region = Region { x: x * across, y: y * down, width: width * across, height: height * down };
    Some(Label { region, visible: f64::from(u8::from(class == 0.0)) })
}

//! `racbot vision`: what an on-board camera sees

use crate::terminal::{Answer, Failure, Table, wrapped};
use clap::{Args, Subcommand};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use vision::ball::DEFAULT_SCORE;
use vision::picture::{Picture, Unusable, read};
use vision::{Scene, detect};

/// Options of `vision`.
#[derive(Args, Debug)]
pub(crate) struct Options {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand, Debug)]
enum Task {
    /// Find ball, field lines, boundary and goals in PNG and JPEG pictures
    Detect(Detect),
}

#[derive(Args, Debug)]
struct Detect {
    /// Pictures, or folders with pictures (*.png, *.jpg, *.jpeg) in them or in their folders
    #[arg(value_name = "FILE|FOLDER", required = true)]
    inputs: Vec<PathBuf>,

    /// Report balls from this score on, 0 to 1
    #[arg(long, value_name = "SCORE", default_value_t = DEFAULT_SCORE, value_parser = score)]
    least: f64,

    /// The pictures are one camera's frames in order: report a frame that equals the one before
    #[arg(long)]
    sequence: bool,
}

fn score(text: &str) -> Result<f64, String> {
    let range = "a score is a number from 0 to 1";
    text.parse().ok().filter(|score| (0.0..=1.0).contains(score)).ok_or_else(|| range.to_owned())
}

impl Options {
    pub(crate) fn run(&self) -> Result<Answer, Failure> {
        match &self.task {
            Task::Detect(detect) => detect.run(),
        }
    }
}

impl Detect {
    fn run(&self) -> Result<Answer, Failure> {
        let mut files = Vec::new();
        for input in &self.inputs {
            gather(input, &mut files);
        }
        let mut table = Table::new(1, &["file", "ball", "x", "y", "size", "score"]);
        let (mut list, mut failed) = (Vec::new(), Vec::new());
        let mut before: Option<Picture> = None;
        for (file, listed) in &files {
            let picture = listed.clone().and_then(|()| read(file).map_err(|error| error.to_string()));
            let seen = picture.and_then(|picture| {
                if self.sequence && before.as_ref() == Some(&picture) {
                    return Err(Unusable::Frozen.to_string());
                }
                let scene = detect(&picture, self.least);
                let size = [picture.width(), picture.height()];
                before = Some(picture);
                Ok((scene, size))
            });
            match seen {
                Ok((scene, size)) => {
                    rows(&mut table, file, &scene);
                    list.push(to_json(file, &scene, size));
                }
                Err(what) => {
                    list.push(json!({ "file": file.display().to_string(), "balls": [], "error": what }));
                    failed.push(format!("{}: {what}", file.display()));
                }
            }
        }
        let wrong = match &failed[..] {
            [] => None,
            [one] => Some(one.clone()),
            [first, rest @ ..] => Some(format!("{first}; and {} more of {} pictures", rest.len(), files.len())),
        };
        let mut text = table.render();
        for line in &failed {
            text += &wrapped(&format!("not used: {line}"), 2);
        }
        Ok(Answer { text, json: list.into(), wrong })
    }
}

const NO_PICTURES: &str = "no pictures in this folder; *.png, *.jpg and *.jpeg are read";

fn is_picture(file: &Path) -> bool {
    let extension = file.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    ["png", "jpg", "jpeg"].contains(&extension.as_str())
}

/// A file itself, or the pictures of a folder and of the folders in it, by name; a folder of no use with the reason. Links
/// to folders are not followed: they may lead in a circle.
fn gather(input: &Path, files: &mut Vec<(PathBuf, Result<(), String>)>) {
    if !input.is_dir() {
        files.push((input.to_owned(), Ok(())));
        return;
    }
    let before = files.len();
    let mut folders = vec![input.to_owned()];
    while let Some(folder) = folders.pop() {
        match fs::read_dir(&folder) {
            Ok(entries) => {
                for entry in entries.flatten() {
                    let path = entry.path();
                    if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
                        folders.push(path);
                    } else if is_picture(&path) && !path.is_dir() {
                        files.push((path, Ok(())));
                    }
                }
            }
            Err(error) => files.push((folder, Err(error.to_string()))),
        }
    }
    if files.len() == before {
        files.push((input.to_owned(), Err(NO_PICTURES.to_owned())));
    }
    files[before..].sort();
}

/// The pictures of one folder by name, without those of folders in it: frames in their order.
pub(crate) fn pictures(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let entries = fs::read_dir(folder).map_err(|error| Failure::about(folder, error))?;
    let known = |file: &PathBuf| is_picture(file) && file.is_file();
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).filter(known).collect();
    files.sort();
    if files.is_empty() { Err(Failure::about(folder, NO_PICTURES)) } else { Ok(files) }
}

fn rows(table: &mut Table, file: &Path, scene: &Scene) {
    let name = file.display().to_string();
    if scene.balls.is_empty() {
        table.row([name, "none".to_owned()]);
        return;
    }
    for (number, ball) in scene.balls.iter().enumerate() {
        let region = ball.region;
        table.row([
            name.clone(),
            format!("{} of {}", number + 1, scene.balls.len()),
            format!("{:.1}", region.x),
            format!("{:.1}", region.y),
            format!("{:.1} x {:.1}", region.width, region.height),
            format!("{:.2}", ball.score),
        ]);
    }
}

fn to_json(file: &Path, scene: &Scene, [width, height]: [usize; 2]) -> Value {
    let tenth = |value: f64| (value * 100.0).round() / 100.0;
    let balls: Vec<Value> = scene
        .balls
        .iter()
        .map(|ball| {
            let r = ball.region;
            json!({ "x": tenth(r.x), "y": tenth(r.y), "width": tenth(r.width), "height": tenth(r.height),
                "score": (ball.score * 1e4).round() / 1e4 })
        })
        .collect();
    let goals: Vec<Value> = scene
        .goals
        .iter()
        .map(|r| json!({ "x": tenth(r.x), "y": tenth(r.y), "width": tenth(r.width), "height": tenth(r.height) }))
        .collect();
    let lines: Vec<Value> = scene.lines.iter().map(|point| json!([tenth(point.x), tenth(point.y)])).collect();
    let boundary: Vec<Value> = scene.boundary.iter().map(|p| json!([tenth(p[0]), tenth(p[1])])).collect();
    json!({ "file": file.display().to_string(), "width": width, "height": height, "balls": balls, "goals": goals, "lines": lines,
        "boundary": boundary })
}

//! Lines in which every number follows its name, as sketches of an Arduino print them: `t,340,PWM,60,speed,1.5`,
//! `t:340 PWM:60 speed:1.5`, `t = 340; PWM = 60`. They become a table with those names. After a colon several may follow:
//! `t: 340 ticks: 290 512` has `ticks_1` and `ticks_2`. Names may have several words, `left motor speed 23 right motor speed
//! 25`, and units may stand after the numbers, `speed: 23 rpm duty: 40 %`.

use super::units;

/// Lines that are looked at to find out.
const LOOKED_AT: usize = 64;

/// The names and, separated by semicolons and each on the line where it was, the rows. A line without the same names in
/// the same order is none: serial lines begin in mid-sentence, and lose bytes.
pub(super) fn table(bytes: &[u8]) -> Option<(Vec<String>, Vec<u8>)> {
    let text = String::from_utf8_lossy(bytes);
    let first: Vec<&str> = text.lines().map(str::trim).filter(|line| !line.is_empty()).take(LOOKED_AT).collect();
    let found: Vec<Vec<(String, &str)>> = first.iter().filter_map(|line| pairs(line)).collect();
    let names_of = |pairs: &[(String, &str)]| pairs.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    let alike = |names: &[String]| found.iter().filter(|pairs| names_of(pairs) == names).count();
    let names = found.iter().map(|pairs| names_of(pairs)).find(|names| 2 * alike(names) >= first.len())?;
    // Below a row of names words are values.
    let fields = |line: &str| line.split([',', ';', '\t']).map(|field| field.trim().to_owned()).collect::<Vec<_>>();
    let headed = first.iter().take_while(|line| pairs(line).is_none()).any(|line| {
        let head = fields(line);
        head.len() == 2 * names.len() && head.iter().all(|field| !field.is_empty() && field.parse::<f64>().is_err())
    });
    if headed || (1..names.len()).any(|i| names[..i].contains(&names[i])) {
        return None;
    }
    let mut rows = Vec::with_capacity(text.len());
    for line in text.lines() {
        let pairs = pairs(line.trim()).filter(|pairs| pairs.iter().map(|(name, _)| name).eq(&names));
        for (i, (_, number)) in pairs.iter().flatten().enumerate() {
            rows.extend((i > 0).then_some(b';'));
            rows.extend_from_slice(number.as_bytes());
        }
        rows.push(b'\n');
    }
    Some((names, rows))
}

/// The names of a line and their numbers: two or more, and nothing else.
fn pairs(line: &str) -> Option<Vec<(String, &str)>> {
    let marked = line.contains([':', '=']);
    let words: Vec<&str> = if marked || line.contains([',', ';', '\t']) {
        let apart = |c: char| [',', ';', '\t', ':', '='].contains(&c) || marked && c == ' ';
        let words = line.split(apart).map(str::trim);
        words.filter(|word| !marked || !word.is_empty()).collect()
    } else {
        line.split_whitespace().collect()
    };
    // A separator may close the line.
    let words = words.strip_suffix(&[""]).unwrap_or(&words);
    let is_name =
        |word: &str| word.starts_with(|c: char| c.is_alphabetic() || c == '_') && word.parse::<f64>().is_err();
    let is_number = |word: &str| word.parse::<f64>().is_ok();
    let is_unit = |word: &str| word != "1" && units::factor(word).is_some();
    let known = |word: &str| is_name(word) || is_number(word) || is_unit(word);
    if !words.first().is_some_and(|word| is_name(word)) || !words.iter().all(|word| known(word)) {
        return None;
    }
    let mut pairs: Vec<(String, &str)> = Vec::with_capacity(words.len());
    let mut groups = 0;
    for group in words.chunk_by(|word, next| is_number(next) || !is_number(word)) {
        let numbers = group.iter().position(|word| is_number(word));
        let (mut name, numbers) = group.split_at(numbers.unwrap_or(group.len()));
        // A word between a number and a name is the number's unit, if it is one.
        if let ([first, rest @ ..], Some(last)) = (name, pairs.last_mut())
            && is_unit(first)
            && (!rest.is_empty() || numbers.is_empty())
        {
            last.0 = format!("{} [{first}]", last.0);
            name = rest;
        }
        let name_of = name.join(" ");
        match numbers {
            [] if name.is_empty() => continue,
            [] => return None,
            [number] => pairs.push((name_of, *number)),
            // Without a mark a word may well have columns of their own after it.
            _ if !marks(line, &name_of) => return None,
            _ => pairs.extend(numbers.iter().enumerate().map(|(i, number)| (format!("{name_of}_{}", i + 1), *number))),
        }
        groups += 1;
    }
    (groups > 1).then_some(pairs)
}

/// Whether a colon or an equals sign follows a name in a line.
fn marks(line: &str, name: &str) -> bool {
    line.match_indices(name).any(|(at, _)| line[at + name.len()..].trim_start().starts_with([':', '=']))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Option<(String, String)> {
        table(text.as_bytes()).map(|(names, rows)| (names.join(";"), String::from_utf8(rows).unwrap()))
    }

    #[test]
    fn numbers_that_follow_their_names_are_a_table() {
        let wanted = |rows: &str| Some(("t;PWM;v 1".to_owned(), rows.to_owned()));
        let serial =
            "=~=~=~= log of today =~=~=~=\n,PWM,0,v 1,0\nt,10,PWM,60,v 1,1.5\nt,20,PW,60\nt,30,PWM,61,v 1,-2,\n";
        assert_eq!(of(serial), None, "half of it is no such line");
        assert_eq!(of(&format!("{serial}t,40,PWM,9,v 1,nan\n")), wanted("\n\n10;60;1.5\n\n30;61;-2\n40;9;nan\n"));
        let marked = Some(("t;PWM".to_owned(), "1;2\n3;-4e1\n".to_owned()));
        for text in
            ["t:1,PWM:2\nt:3,PWM:-4e1\n", "t: 1  PWM: 2\r\nt: 3  PWM: -4e1\r\n", "t = 1; PWM = 2\nt = 3; PWM=-4e1\n"]
        {
            assert_eq!(of(text), marked, "{text}");
        }
        assert_eq!(of("t 1 PWM 2\nt 3 PWM -4e1\n"), marked);
        let words = Some(("time;left motor speed;right motor speed".to_owned(), "1;23;25\n2;24;-25\n".to_owned()));
        for text in [
            "time 1 left motor speed 23 right motor speed 25\ntime 2 left motor speed 24 right motor speed -25\n",
            "time: 1 left motor speed: 23 right motor speed: 25\ntime: 2 left motor speed: 24 right motor speed: -25\n",
        ] {
            assert_eq!(of(text), words, "{text}");
        }
        let units = Some(("t [ms];wheel speed [rpm];duty [%]".to_owned(), "1;23;40\n2;24;41\n".to_owned()));
        assert_eq!(of("t: 1 ms wheel speed: 23 rpm duty: 40 %\nt: 2 ms wheel speed: 24 rpm duty: 41 %\n"), units);
        let several = Some(("time;ticks_1;ticks_2;x".to_owned(), "\n1.5;2;3;4\n2.5;3;4;-5\n".to_owned()));
        assert_eq!(of("#drive: front\ntime: 1.5 ticks: 2 3 x: 4\ntime: 2.5 ticks: 3 4 x: -5\n"), several);
    }

    #[test]
    fn tables_with_words_stay_what_they_are() {
        for text in [
            "t,a,b,c\n0,1,2,3\n1,2,3,4\n",
            "state,t,mode,v\non,0,auto,1\non,1,auto,2\non,2,auto,3\non,3,auto,4\n",
            "ODOM 0.1 2.5\nODOM 0.2 2.6\n",
            "t,1\nt,2\nt,3\n",
            "a,1,a,2\na,1,a,2\n",
            "IMU;2022:06:01 13:42:57.7;Gyro;1;2\nIMU;2022:06:01 13:42:57.8;Gyro;1;3\n",
            "2018-05-10 12:39:00,1\n2018-05-10 12:39:01,2\n",
            "",
        ] {
            assert_eq!(of(text), None, "{text}");
        }
    }
}

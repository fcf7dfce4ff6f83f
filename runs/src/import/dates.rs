//! Times written as a date and a time of day, or as a time of day alone: `2024-05-01T12:00:03.25Z`, `12:00:03,25`.

/// Days before each month of a year that is none of 366 days.
const DAYS: [f64; 12] = [0.0, 31.0, 59.0, 90.0, 120.0, 151.0, 181.0, 212.0, 243.0, 273.0, 304.0, 334.0];

/// Seconds since 1970, or since midnight where there is no date; `None` for what is neither. A zone after it is the same
/// for all rows, and says nothing of how far they are apart.
pub(super) fn seconds(text: &str) -> Option<f64> {
    let text = text.trim().trim_matches('"');
    let plain = underscored(text);
    let text = plain.as_deref().unwrap_or(text);
    // Pictures and some loggers have colons in the date, too: `2022:06:01 13:42:57`.
    let colons = text.split_once(' ').filter(|(date, _)| date.len() == 10 && date.matches(':').count() == 2);
    let dashed = colons.map(|(date, clock)| format!("{} {clock}", date.replace(':', "-")));
    let text = dashed.as_deref().unwrap_or(text);
    let end = text.find(|c: char| !(c.is_ascii_digit() || ['-', '/'].contains(&c)))?;
    // Tables of bags have a stroke between date and clock as well: `2025/07/11/14:06:03.4`.
    let parts = text[..end].matches(['-', '/']).count();
    let end = if parts == 3 { text[..end].rfind(['-', '/'])? } else { end };
    let (day, clock) = if parts > 0 {
        let clock = text[end..].strip_prefix(['T', ' ', '.', '_', '/'])?;
        (day(&text[..end])?, clock)
    } else {
        (0.0, text)
    };
    let end = clock.find(['Z', '+', '-', ' ']).unwrap_or(clock.len());
    let mut parts = clock[..end].split(':');
    let [hours, minutes] = [parts.next()?, parts.next()?].map(|part| part.parse::<u32>().ok().map(f64::from));
    let seconds: f64 = parts.next()?.replace(',', ".").parse().ok()?;
    let known = parts.next().is_none() && hours? < 24.0 && minutes? < 60.0 && (0.0..61.0).contains(&seconds);
    known.then(|| 86_400.0 * day + 3600.0 * hours.unwrap_or(0.0) + 60.0 * minutes.unwrap_or(0.0) + seconds)
}

/// The usual form of a stamp that is fit to name a file, `2024_04_23_12_31_47_388`: with whole milliseconds or microseconds, all
/// their digits written, or none.
fn underscored(text: &str) -> Option<String> {
    let parts: Vec<&str> = text.split('_').collect();
    let (fraction, whole) = match parts[..] {
        [.., fraction] if parts.len() == 7 && [3, 6].contains(&fraction.len()) => (fraction, &parts[..6]),
        _ if parts.len() == 6 => ("0", &parts[..]),
        _ => return None,
    };
    let [year, month, day, hours, minutes, seconds] = whole[..] else { return None };
    let digits = parts.iter().all(|part| !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit()));
    digits.then(|| format!("{year}-{month}-{day} {hours}:{minutes}:{seconds}.{fraction}"))
}

/// Days since 1970 of a date, year first.
fn day(date: &str) -> Option<f64> {
    let parts: Vec<u32> = date.split(['-', '/']).map(|part| part.parse().ok()).collect::<Option<_>>()?;
    let [year, month, day] = parts[..] else { return None };
    if !((1970..2200).contains(&year) && (1..=12).contains(&month) && (1..=31).contains(&day)) {
        return None;
    }
    let leap = |year: u32| year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    let leaps = (1970..year).filter(|y| leap(*y)).count() as f64;
    let this = f64::from(u8::from(leap(year) && month > 2));
    Some(365.0 * f64::from(year - 1970) + leaps + DAYS[month as usize - 1] + this + f64::from(day - 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_and_times_of_day_are_seconds() {
        assert_eq!(seconds("1970-01-02T00:00:01.5Z"), Some(86_401.5));
        assert_eq!(seconds("2024-03-01 12:00:03"), Some(1_709_294_403.0));
        for same in ["2022-11-16.19:06:18", "2022/11/16 19:06:18", "2022-11-16T19:06:18+01:00", "2022-11-16_19:06:18,0"]
        {
            assert_eq!(seconds(same), Some(1_668_625_578.0), "{same}");
        }
        assert_eq!(seconds("2022:11:16 19:06:18"), Some(1_668_625_578.0));
        assert_eq!(seconds("2022/11/16/19:06:18.5"), Some(1_668_625_578.5));
        assert_eq!(seconds("19:06:18.250"), Some(68_778.25));
        assert_eq!(seconds("2022_11_16_19_06_18"), Some(1_668_625_578.0));
        assert_eq!(seconds("2022_11_16_19_06_18_250"), Some(1_668_625_578.25));
        for none in ["x", "12:60:00", "3-4-2022 10:00:00", "2022-13-01 00:00:00", "10:00", "-0.5", "1e-5", "2022-11-16"]
            .into_iter()
            .chain(["2022_11_16_19_06_18_5", "2022_13_16_19_06_18", "run_1_2_3_4_5", "1_2_3_4_5_6"])
        {
            assert_eq!(seconds(none), None, "{none}");
        }
    }
}

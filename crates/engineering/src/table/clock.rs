//! Times of the day, with or without a date, as loggers stamp their rows.

/// Nanoseconds of a second and of a day.
const SECOND: i128 = 1_000_000_000;
const DAY: i128 = 86_400 * SECOND;

/// Seconds since the first stamp of a column.
#[derive(Clone, Debug, Default)]
pub(super) struct ClockReading {
    first: Option<i128>,
    before: i128,
    /// Midnights that passed between stamps without a date, in nanoseconds.
    midnights: i128,
}

impl ClockReading {
    /// True if a stamp was read.
    pub(super) fn has_begun(&self) -> bool {
        self.first.is_some()
    }

    /// Time of a stamp since the first one, s; `None` for a text that is no stamp. Without a date,
    /// a time more than half a day before the last one is on the next day.
    pub(super) fn seconds(&mut self, text: &str) -> Option<f64> {
        let ClockStamp { has_date, nanoseconds } = ClockStamp::read(text)?;
        let mut at = nanoseconds + self.midnights;
        if !has_date && self.has_begun() && self.before - at > DAY / 2 {
            self.midnights += DAY;
            at += DAY;
        }
        self.before = at;
        let since = at - *self.first.get_or_insert(at);
        // both are exact, so that the quotient is the f64 next to the decimal number
        Some(since as f64 / SECOND as f64)
    }
}

/// A time as written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ClockStamp {
    has_date: bool,
    /// Nanoseconds since midnight, or since the beginning of 1970.
    nanoseconds: i128,
}

impl ClockStamp {
    /// Reads `10:00:00.001`, also after `2026-11-27T`, `2026/11/27 ` or `27.11.2026 `; a comma is a
    /// decimal sign too, and `Z` or `+01:00` may follow a date.
    pub(super) fn read(text: &str) -> Option<ClockStamp> {
        let Some((date, time)) = text.split_once(['T', ' ']) else {
            return Some(ClockStamp { has_date: false, nanoseconds: time_of_day(text)? });
        };
        let (time, offset) = match time.rfind(['Z', '+', '-']) {
            Some(at) => time.split_at(at),
            None => (time, "Z"),
        };
        let nanoseconds = days(date)? * DAY + time_of_day(time.trim())? - of_offset(offset)?;
        Some(ClockStamp { has_date: true, nanoseconds })
    }
}

/// A whole number with this number of digits.
fn whole(text: &str, digits: usize) -> Option<i128> {
    let is_whole = text.len() == digits && text.bytes().all(|byte| byte.is_ascii_digit());
    is_whole.then(|| text.parse().ok())?
}

/// Nanoseconds since midnight.
fn time_of_day(text: &str) -> Option<i128> {
    let mut parts = text.split(':');
    let (hours, minutes, seconds) = (parts.next()?, parts.next()?, parts.next()?);
    let (seconds, fraction) = seconds.split_once(['.', ',']).unwrap_or((seconds, "0"));
    let [hours, minutes, seconds] =
        [whole(hours, hours.len().min(2))?, whole(minutes, 2)?, whole(seconds, 2)?];
    let is_fraction = !fraction.is_empty() && fraction.bytes().all(|byte| byte.is_ascii_digit());
    let is_time = parts.next().is_none() && hours < 24 && minutes < 60 && seconds < 61 && is_fraction;
    let nanoseconds: i128 = format!("{fraction:0<9}").get(..9)?.parse().ok()?;
    is_time.then_some(((hours * 60 + minutes) * 60 + seconds) * SECOND + nanoseconds)
}

/// Nanoseconds by which the clock of a zone is ahead.
fn of_offset(text: &str) -> Option<i128> {
    if text == "Z" {
        return Some(0);
    }
    let sign = if text.starts_with('-') { -1 } else { 1 };
    let digits = text.trim_start_matches(['+', '-']).replace(':', "");
    let (hours, minutes) = (whole(digits.get(..2)?, 2)?, digits.get(2..)?);
    let minutes = if minutes.is_empty() { 0 } else { whole(minutes, 2)? };
    Some(sign * (hours * 60 + minutes) * 60 * SECOND)
}

/// Days since the beginning of 1970.
fn days(date: &str) -> Option<i128> {
    let mut parts = date.split(['-', '/', '.']);
    let [first, second, third] = [parts.next()?, parts.next()?, parts.next()?];
    let [year, month, day] = if date.contains('.') { [third, second, first] } else { [first, second, third] };
    let [year, month, day] = [whole(year, 4)?, whole(month, 2)?, whole(day, 2)?];
    let is_leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let february = if is_leap { 29 } else { 28 };
    let months = [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    let before = usize::try_from(month).ok()?.checked_sub(1)?;
    if parts.next().is_some() || day < 1 || day > *months.get(before)? {
        return None;
    }
    let leap_days = |year: i128| year / 4 - year / 100 + year / 400;
    let of_years = 365 * (year - 1970) + leap_days(year - 1) - leap_days(1969);
    Some(of_years + months.iter().take(before).sum::<i128>() + day - 1)
}

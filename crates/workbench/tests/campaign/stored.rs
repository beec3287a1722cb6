//! Tables of campaigns that were interrupted, truncated or damaged, or that belong to another
//! campaign.

use crate::answer_schema::parsed;
use phea_workbench::command::CampaignChunks;
use phea_workbench::engineering::campaign::{RowFault, StoredSeed};

use super::*;

/// The table of a campaign without interruption.
fn uninterrupted(loaded: &Loaded, requested: &CampaignRequest) -> Page {
    let mut page = Page::default();
    resumed(loaded, requested, &mut page).unwrap();
    page
}

#[test]
fn chunks_in_a_row_are_the_whole() {
    let loaded = load(&SHORT);
    let whole = uninterrupted(&loaded, &request(30));
    assert_eq!(whole.text.lines().count(), 31);
    let mut page = Page::default();
    let chunks = CampaignChunks::new(&source(), &loaded, 1).unwrap();
    assert_eq!(chunks.stored(30, &mut page).unwrap(), 0);
    for runs in [0..7, 7..8, 8..30] {
        page.append(&chunks.lines(runs, lanes(1), &mut |_| true).unwrap()).unwrap();
    }
    assert_eq!(page.text, whole.text);
    assert_eq!(chunks.stored(30, &mut page).unwrap(), 30);
    let stopped = chunks.lines(0..5, lanes(1), &mut |_| false);
    assert!(matches!(stopped, Err(CommandError::Stopped(_))), "{stopped:?}");
}

#[test]
fn an_interrupted_campaign_continues_to_the_same_bytes() {
    let loaded = load(&SHORT);
    let requested = request(30);
    let mut whole = Page::default();
    let answer = resumed(&loaded, &requested, &mut whole).unwrap();
    // torn anywhere: within the header, between two rows, within a row
    let bytes = whole.text.len();
    for torn in [0, 100, whole.text.find('\n').unwrap() + 1, bytes / 2, bytes - 1, bytes] {
        let mut page = Page { text: whole.text[..torn].to_string() };
        let again = resumed(&loaded, &requested, &mut page).unwrap();
        assert!(page.text == whole.text, "torn at {torn} of {bytes}");
        assert_eq!(again, answer);
    }
    // appended to itself
    let mut page = Page { text: whole.text.clone() };
    resumed(&loaded, &request(33), &mut page).unwrap();
    assert!(page.text.starts_with(&whole.text) && page.text.lines().count() == 34);
}

/// A table, and pending rows from when it was left.
struct Pages {
    table: Page,
    ahead: String,
}

impl RowStore for Pages {
    fn stored(&mut self) -> Result<String, String> {
        self.table.stored()
    }

    fn cut(&mut self, bytes: usize) -> Result<(), String> {
        self.table.cut(bytes)
    }

    fn append(&mut self, text: &str) -> Result<(), String> {
        self.table.append(text)
    }

    fn ahead(&mut self) -> Result<String, String> {
        Ok(self.ahead.clone())
    }

    fn keep_ahead(&mut self, text: &str) -> Result<(), String> {
        self.ahead.push_str(text);
        Ok(())
    }

    fn forget_ahead(&mut self) -> Result<(), String> {
        self.ahead.clear();
        Ok(())
    }
}

/// Rows ahead of a slower run are not simulated again; torn ones, those of other campaigns and
/// those already in the table are skipped.
#[test]
fn rows_stored_ahead_are_not_simulated_again() {
    let loaded = load(&SHORT);
    let requested = request(30);
    let whole = uninterrupted(&loaded, &requested);
    let lines: Vec<&str> = whole.text.split_inclusive('\n').collect();
    // runs 0 to 3 in the table; 2 again, 6 to 8, half of 9, and 20 of another campaign ahead of it
    let other = CampaignRequest { seed: 2, ..requested };
    let strange = uninterrupted(&loaded, &other);
    let foreign = strange.text.split_inclusive('\n').nth(21).unwrap();
    let half = &lines[10][..lines[10].len() / 2];
    let ahead = [lines[3], lines[8], lines[7], lines[9], foreign, half].concat();
    let mut pages = Pages { table: Page { text: lines[..5].concat() }, ahead };
    let mut fractions = Vec::new();
    let mut watch = |progress: command::Progress| {
        fractions.push(progress.fraction);
        true
    };
    command::campaign_watched(&source(), &loaded, &[], &requested, (Some(&mut pages), None), &mut watch)
        .unwrap();
    assert_eq!(fractions.first().copied(), Some(7.0 / 30.0));
    assert!(pages.table.text == whole.text && pages.ahead.is_empty());
}

/// A table of a campaign that is stopped at once has complete rows only, and the campaign
/// continues.
#[test]
fn stopping_leaves_whole_rows() {
    let loaded = load(&SHORT);
    let requested = request(600);
    let (mut page, mut calls) = (Page::default(), 0);
    let answer =
        command::campaign_watched(&source(), &loaded, &[], &requested, (Some(&mut page), None), &mut |_| {
            calls += 1;
            calls < 3
        })
        .unwrap();
    let rows = page.text.lines().count() - 1;
    assert!(!answer.affirmative && rows < 600 && page.text.ends_with('\n'));
    let object: Value = parsed(&answer.json);
    assert_eq!((&object["complete"], &object["runs"]["rows"]), (&Value::from(false), &Value::from(rows)));
    resumed(&loaded, &requested, &mut page).unwrap();
    let whole = uninterrupted(&loaded, &requested);
    assert!(page.text == whole.text && whole.text.lines().count() == 601);
}

#[test]
fn a_table_of_another_campaign_is_left_unchanged() {
    let loaded = load(&SHORT);
    let requested = request(4);
    let mut page = Page::default();
    resumed(&loaded, &requested, &mut page).unwrap();
    let before = page.text.clone();
    let other = CampaignRequest { seed: 2, ..requested };
    let refused = |result: Result<String, CommandError>| match result {
        Err(CommandError::Campaign(error)) => error,
        other => panic!("{other:?}"),
    };
    let found = refused(resumed(&loaded, &other, &mut page));
    assert_eq!(found, CampaignError::OtherCampaign { line: 2, seed: 2, stored_seed: StoredSeed::Other(1) });
    assert!(found.to_string().contains("was drawn with seed 1, and this campaign has seed 2"), "{found}");
    let fewer = request(3);
    assert_eq!(
        refused(resumed(&loaded, &fewer, &mut page)),
        CampaignError::MoreStored { seed: 1, stored: 4, requested: 3 }
    );
    let changed = load(&[&SHORT as &[&str], &["controller.saturation=9 V"]].concat());
    let found = refused(resumed(&changed, &requested, &mut page));
    assert_eq!(found, CampaignError::OtherCampaign { line: 2, seed: 1, stored_seed: StoredSeed::Unknown });
    assert_eq!(page.text, before);
    let mut letter = Page { text: "Dear reader".to_string() };
    let found = refused(resumed(&loaded, &requested, &mut letter));
    assert_eq!(found, CampaignError::OtherCampaign { line: 1, seed: 1, stored_seed: StoredSeed::Unknown });
    assert_eq!(letter.text, "Dear reader");
}

fn refusal(result: Result<String, CommandError>) -> CampaignError {
    match result {
        Err(CommandError::Campaign(error)) => error,
        other => panic!("{other:?}"),
    }
}

/// A line that differs from the written one is rejected with its number, and left unchanged;
/// without the lines from there on, the result has identical bytes.
#[test]
fn damaged_rows_are_refused_with_their_line() {
    let loaded = load(&SHORT);
    let requested = request(6);
    let whole = uninterrupted(&loaded, &requested);
    let lines: Vec<&str> = whole.text.split_inclusive('\n').collect();
    let with_third = |third: &str| [&lines[..3].concat(), third, &lines[4..].concat()].concat();
    let cells: Vec<&str> = lines[3].split(',').collect();
    for cell in 2..cells.len() {
        let mut changed = cells.clone();
        let end = if cell + 1 == cells.len() { "\n" } else { "" };
        let other = format!("999999{end}");
        changed[cell] = &other;
        let mut page = Page { text: with_third(&changed.join(",")) };
        let before = page.text.clone();
        let error = refusal(resumed(&loaded, &requested, &mut page));
        assert!(matches!(error, CampaignError::Damaged { line: 4, .. }), "cell {cell}: {error}");
        assert!(error.to_string().contains("head -n 3 keeps those before"), "{error}");
        assert_eq!(page.text, before);
    }
    let stored_lines = whole.text.replace('\n', "\r\n");
    let mut page = Page { text: stored_lines };
    assert_eq!(refusal(resumed(&loaded, &requested, &mut page)), CampaignError::LineEnds { line: 1 });
    let mut page = Page { text: with_third(&lines[3].replace('\n', "\r\n")) };
    assert_eq!(refusal(resumed(&loaded, &requested, &mut page)), CampaignError::LineEnds { line: 4 });
    // one run twice, as two writers would leave it
    let mut page = Page { text: [&whole.text, lines[1]].concat() };
    let error = refusal(resumed(&loaded, &request(9), &mut page));
    assert!(matches!(error, CampaignError::Damaged { line: 8, fault: RowFault::OfAnotherRun }), "{error}");
    let mut page = Page { text: lines[..3].concat() };
    resumed(&loaded, &requested, &mut page).unwrap();
    assert_eq!(page.text, whole.text);
}

/// A row with a valid checksum whose numbers are not those of its draw.
#[test]
fn stored_numbers_are_the_drawn_ones() {
    let loaded = load(&SHORT);
    let plan = plan(&[]);
    let mut rows = plan.rows(0..3, lanes(1)).unwrap();
    let requested = request(3);
    resumed(&loaded, &requested, &mut Page { text: plan.table(&rows) }).unwrap();
    rows[1].values[0] = rows[1].values[0].next_up();
    let error = refusal(resumed(&loaded, &requested, &mut Page { text: plan.table(&rows) }));
    assert!(matches!(error, CampaignError::Damaged { line: 3, fault: RowFault::OtherNumbers }), "{error}");
}

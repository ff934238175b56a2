//! A table of results.

/// Rows under a header, as text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// What the table shows.
    pub caption: String,
    /// What the columns hold.
    pub header: Vec<String>,
    /// As many cells each as the header has.
    pub rows: Vec<Vec<String>>,
    /// How many columns are text, from the left; the others are numbers.
    pub text: usize,
}

impl Table {
    /// A table without rows.
    pub(super) fn new(caption: impl Into<String>, header: &[&str]) -> Self {
        Self {
            caption: caption.into(),
            header: header.iter().map(|&name| name.to_owned()).collect(),
            rows: Vec::new(),
            text: 1,
        }
    }

    pub(super) fn push(&mut self, row: Vec<String>) {
        self.rows.push(row);
    }

    /// As CSV, with the header.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let lines = std::iter::once(&self.header).chain(&self.rows);
        for line in lines {
            // Memory does not run out of order, and rows are as long as the header.
            let _ = writer.write_record(line);
        }
        let bytes = writer.into_inner().unwrap_or_default();
        String::from_utf8_lossy(&bytes).into_owned()
    }

    /// As Markdown; numbers stand right.
    #[must_use]
    pub fn markdown(&self) -> String {
        let line = |cells: &[String]| {
            let cells: Vec<String> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
            format!("| {} |\n", cells.join(" | "))
        };
        let rule = self.header.iter().enumerate();
        let rule: Vec<String> = rule
            .map(|(index, _)| if index < self.text { "---" } else { "--:" }.to_owned())
            .collect();
        let rows: String = self.rows.iter().map(|row| line(row)).collect();
        format!("{}{}{rows}", line(&self.header), line(&rule))
    }
}

/// The mean of numbers; of none, not a number.
pub(super) fn mean(values: impl IntoIterator<Item = f64>) -> f64 {
    let (sum, count) = values
        .into_iter()
        .fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_quoted_where_their_form_needs_it() {
        let mut table = Table::new("", &["object", "F, %"]);
        table.push(vec!["a|b".to_owned(), "1".to_owned()]);
        assert_eq!(table.csv(), "object,\"F, %\"\na|b,1\n");
        assert_eq!(
            table.markdown(),
            "| object | F, % |\n| --- | --: |\n| a\\|b | 1 |\n"
        );
    }

    #[test]
    fn the_mean_of_nothing_is_no_number() {
        assert_eq!(mean([1.0, 2.0, 6.0]), 3.0);
        assert!(mean([]).is_nan());
    }
}

//! What boards take stands in README and on the pages of `cobra report`: the same numbers.

use cobra_train::report::{boards, compiler};

const README: &str = include_str!("../../README.md");

#[test]
fn the_boards_of_the_pages_are_those_of_readme() {
    assert!(README.contains(&format!("Built by {}, ", compiler())));
    let rows = README.lines().filter(|line| line.ends_with(" points |"));
    assert_eq!(rows.count(), boards().len());
    for board in boards() {
        let [one, half] = board.evaluation;
        let row = format!(
            "| `{}`, {} | {} | {} | {} | {} | {} | {} | {} | {one:.1} | {half:.1} | ",
            board.target,
            board.board,
            board.code,
            board.stack,
            board.depth_code,
            board.depth_stack,
            board.point,
            board.component,
            board.component_with_precisions,
        );
        assert!(README.contains(&row), "{row}");
    }
}

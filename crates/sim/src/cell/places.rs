//! Where a workcell file says what: for messages about what a program needs and the file has not,
//! or has by another name. Knows no meanings.

use super::CellError;
use super::file::CellFile;
use std::ops::Range;
use toml::Spanned;

/// Where the lines and names of a workcell file stand. Lines and columns count from 1.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CellPlaces {
    /// Where it says how many outputs there are, if it does.
    pub outputs: Option<(usize, usize)>,
    /// Where it says how many inputs there are, if it does.
    pub inputs: Option<(usize, usize)>,
    /// The items by name, each with where it is named.
    pub items: Vec<(String, (usize, usize))>,
    /// The tools by name, each with where it is named.
    pub tools: Vec<(String, (usize, usize))>,
}

impl CellPlaces {
    /// Those of the text of a workcell file. Of a text that is none, there are no places.
    #[must_use]
    pub fn of(text: &str) -> Self {
        let Ok(file) = toml::from_str::<CellFile>(text) else { return Self::default() };
        let place = |span: Range<usize>| {
            let CellError { line, column, .. } = CellError::at(text, span.start, "");
            (line, column)
        };
        // What is not written has the span of a default.
        let written = |count: &Spanned<u16>| {
            let span = count.span();
            (!span.is_empty()).then(|| place(span))
        };
        let named = |name: &Spanned<String>| (name.get_ref().clone(), place(name.span()));
        Self {
            outputs: written(&file.outputs.count),
            inputs: written(&file.inputs.count),
            items: file.item.iter().map(|item| named(&item.name)).collect(),
            tools: file.tool.iter().map(|tool| named(&tool.name)).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_has_a_place() {
        let text = "[arm]\nhome_rad = [0, 0, 0, 0, 0, 0]\n[outputs]\ncount = 4\n\
                    [[tool]]\nname = \"gripper\"\n\
                    [[item]]\nplace = { }\nname = \"peg\"\n";
        let places = CellPlaces::of(text);
        assert_eq!((places.outputs, places.inputs), (Some((4, 9)), None));
        assert_eq!(places.tools, [("gripper".to_owned(), (6, 8))]);
        assert_eq!(places.items, [("peg".to_owned(), (9, 8))]);
    }

    #[test]
    fn a_text_that_is_no_workcell_has_no_places() {
        assert_eq!(CellPlaces::of("[arm"), CellPlaces::default());
    }
}

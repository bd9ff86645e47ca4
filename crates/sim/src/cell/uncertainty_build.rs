//! From the keys that say what may go wrong to checked numbers: names are found, and what could
//! never happen is refused.

use super::build::{Builder, MM, level, offset};
use super::file::CellFile;
use super::number::Probability;
use super::uncertainty_file::{CentresFile, ChanceFile, FallingFile, FeederFile, SlipFile};
use super::{
    CellCode, CellError, ChanceSpec, FallSpec, FeederSpec, InputFlaw, InputRule, ItemSpec,
    OffsetSpec, SlipSpec,
};
use toml::Spanned;

const FEEDERS_MAX: usize = 64;
/// How near a part must be to its place to be seen there, if the file does not say, in metres.
const NEAR_M: f64 = 0.01;
const SUPPORT_M: f64 = 0.005;
const KNOCK_N: f64 = 20.0;
/// By how much probabilities may add up to more than 1, since they are rounded.
const SUM_EPSILON: f64 = 1e-9;

impl Builder<'_> {
    pub(super) fn slip(&self, file: &Spanned<SlipFile>) -> Result<SlipSpec, CellError> {
        let slip = file.get_ref();
        let of = |probability: &Option<Probability>| probability.map_or(0.0, |p| p.0);
        if let (None, Some(fast)) = (&slip.fast_mm_per_s, &slip.fast) {
            return Err(self.error(fast, "`fast` needs `fast_mm_per_s`: faster than what?"));
        }
        if let (Some(speed), None) = (&slip.fast_mm_per_s, &slip.fast) {
            return Err(self.error(speed, "`fast_mm_per_s` belongs to `fast`, a probability"));
        }
        if let (Some(force), None) = (&slip.contact_n, &slip.in_contact) {
            return Err(self.error(force, "`contact_n` belongs to `in_contact`, a probability"));
        }
        let spec = SlipSpec {
            probability: of(&slip.probability),
            in_contact: of(&slip.in_contact),
            contact_n: slip.contact_n.as_ref().map_or(0.0, |force| force.get_ref().0),
            fast: slip.fast.as_ref().map_or(0.0, |fast| fast.get_ref().0),
            fast_m_per_s: slip.fast_mm_per_s.as_ref().map_or(0.0, |v| v.get_ref().0 * MM),
            offset: offset(&slip.offset),
            lost: of(&slip.lost),
        };
        if spec.offset == OffsetSpec::default() && spec.lost == 0.0 {
            return Err(self.error(file, "a slip has an `offset`, or a probability to be `lost`"));
        }
        Ok(spec)
    }

    /// The feeders; their inputs get the rule that says whether the part is there.
    pub(super) fn feeders(
        &self,
        file: &CellFile,
        items: &[ItemSpec],
        outputs: u16,
        inputs: &mut [InputRule],
    ) -> Result<Vec<FeederSpec>, CellError> {
        self.at_most("feeders", file.feeder.len(), FEEDERS_MAX)?;
        self.unique(file.feeder.iter().map(|feeder| &feeder.name))?;
        let mut feeders: Vec<FeederSpec> = Vec::with_capacity(file.feeder.len());
        for (index, feeder) in file.feeder.iter().enumerate() {
            let spec = self.feeder(feeder, items, outputs)?;
            if feeders.iter().any(|other| other.item == spec.item) {
                let message = format!("another feeder presents `{}`", feeder.item.get_ref());
                return Err(self.error(&feeder.item, message).of(CellCode::Twice));
            }
            feeders.push(spec);
            if let Some(input) = &feeder.input {
                self.feeder_input(input, index, file, inputs)?;
            }
        }
        Ok(feeders)
    }

    fn feeder(
        &self,
        file: &FeederFile,
        items: &[ItemSpec],
        outputs: u16,
    ) -> Result<FeederSpec, CellError> {
        let item = items.iter().position(|item| &item.name == file.item.get_ref());
        let item = item.ok_or_else(|| {
            let message = format!("there is no item `{}`", file.item.get_ref());
            self.error(&file.item, message).of(CellCode::UnknownName)
        })?;
        let askew_offset = offset(&file.askew_offset);
        if let Some(askew) = &file.askew
            && askew.get_ref().0 > 0.0
            && askew_offset == OffsetSpec::default()
        {
            return Err(self.error(askew, "`askew` needs an `askew_offset`: how far is it off?"));
        }
        Ok(FeederSpec {
            name: file.name.get_ref().clone(),
            item,
            output: self.output(&file.output, outputs)?,
            asks_level: level(file.asks),
            delay_s: file.delay_s.map_or(0.0, |delay| delay.0),
            is_ready: file.ready,
            parts: file.parts,
            empty: file.empty.map_or(0.0, |empty| empty.0),
            askew: file.askew.as_ref().map_or(0.0, |askew| askew.get_ref().0),
            askew_offset,
            near_m: file.near_mm.map_or(NEAR_M, |near| near.0 * MM),
        })
    }

    fn feeder_input(
        &self,
        input: &Spanned<u16>,
        feeder: usize,
        file: &CellFile,
        inputs: &mut [InputRule],
    ) -> Result<(), CellError> {
        let index = self.input(input, inputs.len())?;
        let has_rule = file.inputs.rule.iter().any(|rule| rule.input.get_ref() == input.get_ref());
        if has_rule || matches!(inputs[index], InputRule::PartThere { .. }) {
            let message = format!("input {index} has a rule already");
            return Err(self.error(input, message).of(CellCode::Twice));
        }
        inputs[index] = InputRule::PartThere { feeder };
        Ok(())
    }

    fn input(&self, input: &Spanned<u16>, count: usize) -> Result<usize, CellError> {
        let index = usize::from(*input.get_ref());
        if index < count {
            return Ok(index);
        }
        let message = format!("there is no input {index}: inputs are 0 to below {count}");
        Err(self.error(input, message).of(CellCode::UnknownName))
    }

    pub(super) fn chance(&self, file: &CellFile, outputs: u16) -> Result<ChanceSpec, CellError> {
        let of = |probability: Option<Probability>| probability.map_or(0.0, |p| p.0);
        self.at_most_one(&file.chance)?;
        let file_chance = file.chance.get_ref();
        let mut chance = ChanceSpec {
            stops_short: of(file_chance.stops_short),
            protective_stop: of(file_chance.protective_stop),
            emergency_stop: of(file_chance.emergency_stop),
            ..ChanceSpec::default()
        };
        for stick in &file.outputs.stick {
            let index = usize::from(self.output(&stick.output, outputs)?);
            self.once(&stick.output, file.outputs.stick.iter().map(|stick| &stick.output))?;
            if chance.output_sticks.len() <= index {
                chance.output_sticks.resize(index + 1, 0.0);
            }
            chance.output_sticks[index] = stick.probability.0;
        }
        let count = *file.inputs.count.get_ref();
        for stick in &file.inputs.stick {
            self.once(&stick.input, file.inputs.stick.iter().map(|stick| &stick.input))?;
            self.flaw(&mut chance, &stick.input, count)?.stick = stick.probability.0;
        }
        for bounce in &file.inputs.bounce {
            self.once(&bounce.input, file.inputs.bounce.iter().map(|bounce| &bounce.input))?;
            let flaw = self.flaw(&mut chance, &bounce.input, count)?;
            flaw.bounce = bounce.probability.map_or(1.0, |p| p.0);
            flaw.bounce_s = bounce.for_s.0;
        }
        Ok(chance)
    }

    /// Refuse more to end a motion than there are motions: each is ended by one thing at most.
    fn at_most_one(&self, file: &Spanned<ChanceFile>) -> Result<(), CellError> {
        let ChanceFile { stops_short, protective_stop, emergency_stop } = file.get_ref();
        let all = [stops_short, protective_stop, emergency_stop];
        let sum: f64 = all.into_iter().flatten().map(|probability| probability.0).sum();
        if sum <= 1.0 + SUM_EPSILON {
            return Ok(());
        }
        let message = format!(
            "`stops_short`, `protective_stop` and `emergency_stop` add up to {sum:.4}, and a \
             motion ends by one of them at most: together they must be from 0 to 1"
        );
        Err(self.error(file, message))
    }

    /// Refuse a line that stands in a list before this.
    fn once<'l>(
        &self,
        line: &Spanned<u16>,
        mut list: impl Iterator<Item = &'l Spanned<u16>>,
    ) -> Result<(), CellError> {
        let first = list.find(|other| other.get_ref() == line.get_ref());
        if first.is_some_and(|first| first.span() != line.span()) {
            let message = format!("line {} is here twice", line.get_ref());
            return Err(self.error(line, message).of(CellCode::Twice));
        }
        Ok(())
    }

    fn flaw<'c>(
        &self,
        chance: &'c mut ChanceSpec,
        input: &Spanned<u16>,
        count: u16,
    ) -> Result<&'c mut InputFlaw, CellError> {
        let index = self.input(input, usize::from(count))?;
        let flaws = &mut chance.input_flaws;
        if flaws.len() <= index {
            flaws.resize(index + 1, InputFlaw::default());
        }
        Ok(&mut flaws[index])
    }
}

pub(super) fn centres(file: CentresFile) -> [bool; 2] {
    match file {
        CentresFile::Nothing => [false, false],
        CentresFile::X => [true, false],
        CentresFile::Y => [false, true],
        CentresFile::Xy => [true, true],
    }
}

pub(super) fn falling(file: &FallingFile) -> FallSpec {
    FallSpec {
        support_m: file.support_mm.map_or(SUPPORT_M, |support| support.0 * MM),
        knock_n: file.knock_n.map_or(KNOCK_N, |force| force.0),
    }
}

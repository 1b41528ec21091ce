//! Channels of a solid that was made of other solids.

use super::fill::fill;
use super::source::{Known, Source};
use crate::control::Control;
use crate::error::Error;
use crate::lattice::Cell;
use crate::lattice::Each;
use crate::memory;
use crate::octree::channel::{Bits, Spot};
use crate::octree::{Channel, ChannelRef, Octree, OctreeRef, ValueType};
use crate::op::{Rule, build};
use crate::solid::Verdict;
use crate::solid::stored::StoredPart;
use alloc::string::String;
use alloc::vec::Vec;

/// The rule for the value of a point that lies in several operands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum CarryRule {
    /// The value of the first operand that has one.
    #[default]
    Left,
    /// The value of the last operand that has one.
    Right,
    /// The greatest of all values, component by component.
    Max,
    /// The mean of all values, component by component, rounded to the type.
    Mean,
}

/// An operand of an operation on solids, with its channel.
#[derive(Debug, Clone, Copy)]
pub struct ChannelOperand<'a> {
    /// The operand itself: its channel counts where the operand is not EMPTY.
    pub solid: &'a OctreeRef<'a>,
    /// The values of the operand.
    pub channel: &'a ChannelRef<'a>,
}

/// Computes the channel of `result`, an octree that was made of operands in the same cube by any operation.
/// At each point the values of those operands count that are not EMPTY there, combined by `rule`. Where
/// `result` is EMPTY, the channel has the values that take the least memory.
///
/// The channel is as deep as the deepest of the operands' solids and channels. The cuts of solids that keep
/// surfaces do not count: such solids are used down to the depth of their cells
/// ([`plain`](crate::op::plain)). The result has the same bits for any number of threads. The cost is
/// proportional to the number of cells at which solids or channels change.
///
/// # Errors
/// [`Error::Argument`] if there is no operand, or if the values have different types;
/// [`Error::FrameMismatch`] unless all lie in one cube; [`Error::Damaged`] for damaged links; and the errors
/// that `control` causes.
pub fn carry_channel(
    result: &OctreeRef<'_>,
    operands: &[ChannelOperand<'_>],
    rule: CarryRule,
    control: &Control<'_>,
) -> Result<Channel, Error> {
    let refused = |name, problem| Err(Error::Argument { name, problem });
    let Some(first) = operands.first() else { return refused("operands", "must be at least one") };
    let value_type = first.channel.value_type();
    if operands.iter().any(|operand| operand.channel.value_type() != value_type) {
        return refused("operands", "must have channels of one type");
    }
    let mut depth = 1;
    result.check_links()?;
    for ChannelOperand { solid, channel } in operands {
        for frame in [solid.frame(), channel.frame()] {
            if !frame.same_universe(result.frame()) {
                return Err(result.frame().mismatch(frame));
            }
        }
        depth = depth.max(channel.frame().depth());
        if solid.cuts.is_none() {
            depth = depth.max(solid.frame().depth());
        }
        solid.check_links()?;
    }
    let frame = result.frame().with_depth(depth)?;
    // Cells that keep surfaces are larger than the details that they describe.
    let plain = |tree: &OctreeRef<'_>| match tree.cuts {
        Some(_) => build(tree, &frame, Rule::Certified, control).map(Some),
        None => Ok(None),
    };
    let plain_result = plain(result)?;
    let mut solids = memory::with_capacity(operands.len())?;
    for operand in operands {
        solids.push(plain(operand.solid)?);
    }
    let mut meant = memory::with_capacity(operands.len())?;
    for (operand, plain) in operands.iter().zip(&solids) {
        meant.push(ChannelOperand { solid: plain.as_ref().map_or(operand.solid, Octree::view), ..*operand });
    }
    let result = plain_result.as_ref().map_or(result, Octree::view);
    fill(&Carried { result, operands: &meant, rule, value_type }, &frame, value_type, control)
}

/// Attaches to `result`, an octree that was made of `operands`, their channels. Channels of one name become
/// one channel, by the rule that `rule` returns for that name; see [`carry_channel`]. A channel of only one
/// operand is shared unchanged. The metadata is that of the first operand that has the channel.
///
/// # Errors
/// As [`carry_channel`].
///
/// ```
/// use leafless::{
///     Control, Csg, Frame, Rule, build, union,
///     attribute::{CarryRule, ConstantAttribute, FillOptions, ScalarType, ValueType, carry_channels, fill_channel},
/// };
/// let (frame, control) = (Frame::new([0.0; 3], 4.0, 5)?, Control::default());
/// let value_type = ValueType::new(ScalarType::U8, 1)?;
/// let part = |min: f64, max: f64, material: f64| {
///     let solid = build(&Csg::cuboid([min, 0.0, 0.0], [max, 1.0, 1.0])?, &frame, Rule::Certified, &control)?;
///     let options = FillOptions { value_type, frame, solid: None, detail: None };
///     let material = fill_channel(&ConstantAttribute::new(&[material])?, &options, &control)?;
///     solid.with_channel(material.with_name("material"))
/// };
/// let (a, b) = (part(0.0, 2.0, 1.0)?, part(1.0, 3.0, 2.0)?);
/// let both = union(a.view(), b.view(), &control)?;
/// let both = carry_channels(&both, &[&a, &b], |_| CarryRule::Left, &control)?;
/// let material = both.channel("material").unwrap().view()?;
/// let at = |x: f64| material.value_at([x, 0.5, 0.5]).unwrap()[0];
/// assert_eq!([at(0.5), at(1.5), at(2.5)], [1.0, 1.0, 2.0]);
/// # Ok::<(), leafless::Error>(())
/// ```
pub fn carry_channels(
    result: &Octree,
    operands: &[&Octree],
    rule: impl Fn(&str) -> CarryRule,
    control: &Control<'_>,
) -> Result<Octree, Error> {
    let mut names: Vec<String> = Vec::new();
    for channel in operands.iter().flat_map(|operand| operand.channels()) {
        if !names.iter().any(|name| name == channel.name()) {
            memory::push(&mut names, memory::text(channel.name())?)?;
        }
    }
    let mut carried = result.clone();
    let parts = names.len() as f64;
    for (name, i) in names.iter().zip(0..) {
        let mut bearing = Vec::new();
        for operand in operands {
            if let Some(channel) = operand.channel(name) {
                memory::push(&mut bearing, (operand, channel))?;
            }
        }
        let [(_, first), more @ ..] = &bearing[..] else { continue };
        let channel = if more.is_empty() {
            (*first).clone()
        } else {
            let mut list = memory::with_capacity(bearing.len())?;
            for (operand, channel) in &bearing {
                list.push(ChannelOperand { solid: operand.view(), channel: channel.view()? });
            }
            let share = [f64::from(i) / parts, (f64::from(i) + 1.0) / parts];
            let carry = |control: &Control<'_>| carry_channel(result.view(), &list, rule(name), control);
            control.share(share, carry)?.with_metadata(first.metadata().clone())
        };
        carried = carried.with_channel(channel)?;
    }
    Ok(carried)
}

struct Carried<'a> {
    result: &'a OctreeRef<'a>,
    operands: &'a [ChannelOperand<'a>],
    rule: CarryRule,
    value_type: ValueType,
}

/// The state of a cell in the result and in all operands.
#[derive(Clone)]
struct Part {
    result: Verdict<StoredPart>,
    operands: Vec<(Verdict<StoredPart>, Spot)>,
}

impl Carried<'_> {
    fn known(&self, part: Part) -> Known<Part> {
        if matches!(part.result, Verdict::Empty) {
            return Known::Free;
        }
        match self.value(&part, false) {
            Ok(value) => Known::Settled(value),
            Err(Unsettled) => Known::Open(part),
        }
    }

    /// The value of a whole cell. A finest cell that an operand cuts counts as inside the operand.
    fn value(&self, part: &Part, finest: bool) -> Result<Option<Bits>, Unsettled> {
        let mut bearing = part.operands.iter().filter(|(verdict, _)| !matches!(verdict, Verdict::Empty));
        let one = |(verdict, spot): &(Verdict<StoredPart>, Spot)| match (verdict, spot) {
            (_, Spot::Settled(None)) => Ok(None),
            (Verdict::Partial(_), _) if !finest => Err(Unsettled),
            (_, Spot::Settled(value)) => Ok(*value),
            (_, Spot::Split(_)) => Err(Unsettled),
        };
        match self.rule {
            CarryRule::Left => bearing.map(one).find_map(Result::transpose).transpose(),
            CarryRule::Right => bearing.rev().map(one).find_map(Result::transpose).transpose(),
            CarryRule::Max | CarryRule::Mean => {
                let (mut sum, mut count) = ([0.0; 4], 0.0);
                bearing.try_for_each(|operand| {
                    if let Some(bits) = one(operand)? {
                        let value = self.value_type.decode(bits);
                        for (sum, value) in sum.iter_mut().zip(value) {
                            *sum = match self.rule {
                                CarryRule::Mean => *sum + value,
                                _ if count > 0.0 => value.max(*sum),
                                _ => value,
                            };
                        }
                        count += 1.0;
                    }
                    Ok(())
                })?;
                if count == 0.0 {
                    return Ok(None);
                }
                let mean = if self.rule == CarryRule::Mean { sum.each(|sum| sum / count) } else { sum };
                // A value between valid values is valid.
                Ok(self.value_type.encode(mean).ok())
            }
        }
    }
}

/// The error for a cell in which operands or channels change.
struct Unsettled;

impl Source for Carried<'_> {
    type Part = Part;

    fn root(&self) -> Result<Known<Part>, Error> {
        let roots = self.operands.iter().map(|o| (o.solid.root_verdict(), o.channel.root()));
        Ok(self.known(Part { result: self.result.root_verdict(), operands: memory::collected(roots)? }))
    }

    fn split(&self, _: Cell, part: &Part) -> Result<[Known<Part>; 8], Error> {
        let result = self.result.verdicts_below(&part.result);
        let mut parts: [Part; 8] = result.each(|result| Part { result, operands: Vec::new() });
        for part_of_child in &mut parts {
            part_of_child.operands.try_reserve_exact(self.operands.len())?;
        }
        for (operand, (verdict, spot)) in self.operands.iter().zip(&part.operands) {
            let below = operand.solid.verdicts_below(verdict).into_iter().zip(operand.channel.children(spot));
            for (part, child) in parts.iter_mut().zip(below) {
                part.operands.push(child);
            }
        }
        Ok(parts.each(|part| self.known(part)))
    }

    fn settle(&self, cells: &[(Cell, Part)], values: &mut [Option<Bits>]) -> Result<(), Error> {
        for (value, (_, part)) in values.iter_mut().zip(cells) {
            // Channels are no deeper than the result.
            *value = self.value(part, true).unwrap_or(None);
        }
        Ok(())
    }
}

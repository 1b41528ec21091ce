//! Statistics of the samples of a volume: their range, and the threshold that separates them best.

use leafless::solid::Samples;

/// Number of classes for numbers of single precision. Integers of 8 and 16 bits have a class for each value.
const CLASSES: usize = 4096;

/// Returns the least and the greatest sample; `None` if no sample is finite.
pub fn range(samples: &Samples<'_>) -> Option<[f64; 2]> {
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    each(samples, |sample| range = [range[0].min(sample), range[1].max(sample)]);
    (range[0] <= range[1]).then_some(range)
}

/// Returns the threshold with the greatest variance between both sides (Otsu's method). Samples from the
/// threshold on are inside. `None` if all samples are equal.
pub fn best_threshold(samples: &Samples<'_>) -> Option<f64> {
    let [least, greatest] = range(samples).filter(|[least, greatest]| least < greatest)?;
    let is_whole = matches!(samples, Samples::U8(_) | Samples::U16(_) | Samples::I16(_) | Samples::Bits(_));
    let classes = if is_whole { (greatest - least) as usize + 1 } else { CLASSES };
    let width = if is_whole { 1.0 } else { (greatest - least) / classes as f64 };
    let mut counts = vec![0u64; classes];
    each(samples, |sample| counts[(((sample - least) / width) as usize).min(classes - 1)] += 1);

    let total = counts.iter().sum::<u64>() as f64;
    let sum: f64 = counts.iter().enumerate().map(|(class, &count)| class as f64 * count as f64).sum();
    let (mut below, mut sum_below) = (0.0, 0.0);
    // The first and the last of the best thresholds: between two groups, all thresholds are equally good.
    let (mut best, mut ends) = (-1.0, [0; 2]);
    for (class, &count) in counts.iter().enumerate().take(classes - 1) {
        below += count as f64;
        sum_below += class as f64 * count as f64;
        let apart = sum_below / below - (sum - sum_below) / (total - below);
        let variance = below * (total - below) * apart * apart;
        if variance > best * (1.0 + 1e-12) {
            (best, ends) = (variance, [class; 2]);
        } else if variance >= best * (1.0 - 1e-12) {
            ends[1] = class;
        }
    }
    let middle = (ends[0] + ends[1]) as f64 / 2.0 + 1.0;
    Some(least + (if is_whole { middle.ceil() } else { middle }) * width)
}

/// Calls a function with all finite samples.
fn each(samples: &Samples<'_>, mut call: impl FnMut(f64)) {
    match samples {
        // (The bits behind the end of a row are no samples; the exact number of zeros does not matter.)
        Samples::Bits(words) => {
            for &word in words.values() {
                (0..64).for_each(|bit| call((word >> bit & 1) as f64));
            }
        }
        Samples::U8(values) => values.values().iter().for_each(|&value| call(value.into())),
        Samples::U16(values) => values.values().iter().for_each(|&value| call(value.into())),
        Samples::I16(values) => values.values().iter().for_each(|&value| call(value.into())),
        Samples::F32(values) => {
            values.values().iter().filter(|value| value.is_finite()).for_each(|&value| call(value.into()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_groups_are_parted_in_the_middle_between_them() {
        let groups: Vec<u16> = [vec![100; 900], vec![140; 900], vec![1000; 50], vec![1100; 50]].concat();
        let threshold = best_threshold(&groups.clone().into()).unwrap();
        assert!((565.0..=575.0).contains(&threshold), "{threshold}");
        let halves: Vec<f32> = groups.iter().map(|&sample| f32::from(sample) / 2.0 - 300.0).collect();
        let threshold = best_threshold(&halves.into()).unwrap();
        assert!((-20.0..=-10.0).contains(&threshold), "{threshold}");
        assert_eq!(best_threshold(&vec![7i16, 8].into()), Some(8.0));
        assert_eq!(best_threshold(&vec![7i16; 5].into()), None);
        assert_eq!(range(&vec![f32::NAN, f32::INFINITY, 2.0, -1.0].into()), Some([-1.0, 2.0]));
        assert_eq!(range(&vec![f32::NAN].into()), None);
    }
}

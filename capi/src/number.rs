//! The host's numbers for members of enumerations.

use super::boundary::Failure;
use core::marker::PhantomData;

/// A number that a host gives for a member of an enumeration, not checked yet. In the header it has the
/// enumeration's type, so that a C++ compiler refuses members of other enumerations.
#[repr(transparent)]
pub struct Number<E>(u32, PhantomData<E>);

/// Like [`Number`], for an enumeration whose members have 8 bits.
#[repr(transparent)]
pub struct Byte<E>(pub(super) u8, PhantomData<E>);

impl<E> Clone for Number<E> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<E> Copy for Number<E> {}

/// An enumeration whose members stand for values of the library.
pub trait Enumeration {
    type Known;
    /// The error text for a number that is not a member.
    const PROBLEM: &'static str;

    fn known(number: u32) -> Option<Self::Known>;
}

impl<E> Number<E> {
    /// The member with the number 0, which every enumeration has.
    pub(super) const ZERO: Number<E> = Number(0, PhantomData);
}

impl<E: Enumeration> Number<E> {
    /// Returns the library's value of the member. `name` is the name of the parameter, for messages.
    pub(super) fn known(self, name: &'static str) -> Result<E::Known, Failure> {
        E::known(self.0).ok_or(Failure::Argument { name, problem: E::PROBLEM })
    }
}

/// Maps the members of an enumeration with 32-bit numbers to values of the library.
macro_rules! enumeration {
    ($enumeration:ident => $known:ty { $($member:ident => $value:expr,)+ }) => {
        impl $crate::number::Enumeration for $enumeration {
            type Known = $known;
            const PROBLEM: &'static str = concat!("is no ", stringify!($enumeration));

            fn known(number: u32) -> Option<$known> {
                match number {
                    $(_ if number == $enumeration::$member as u32 => Some($value),)+
                    _ => None,
                }
            }
        }
    };
}
pub(super) use enumeration;

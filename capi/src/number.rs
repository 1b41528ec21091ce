//! Numbers of the host that stand for a member of an enumeration.

use super::boundary::Failure;
use core::marker::PhantomData;

/// A number that a host gives for a member of an enumeration; nobody has looked at it. In the header it has
/// the enumeration's type, so that a compiler for C++ sees when it is another one's.
#[repr(transparent)]
pub struct Number<E>(u32, PhantomData<E>);

/// As [`Number`], for an enumeration whose members have 8 bits.
#[repr(transparent)]
pub struct Byte<E>(pub(super) u8, PhantomData<E>);

impl<E> Clone for Number<E> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<E> Copy for Number<E> {}

/// An enumeration, and what the library has for its members.
pub trait Enumeration {
    type Known;
    /// What is said of a number that is no member.
    const PROBLEM: &'static str;

    fn known(number: u32) -> Option<Self::Known>;
}

impl<E> Number<E> {
    /// The member that is zero, which every enumeration has.
    pub(super) const ZERO: Number<E> = Number(0, PhantomData);
}

impl<E: Enumeration> Number<E> {
    /// What the library has for the member. `name` is the parameter that the number was given for.
    pub(super) fn known(self, name: &'static str) -> Result<E::Known, Failure> {
        E::known(self.0).ok_or(Failure::Argument { name, problem: E::PROBLEM })
    }
}

/// Says what the library has for the members of an enumeration whose numbers have 32 bits.
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

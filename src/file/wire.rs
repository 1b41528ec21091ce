//! Numbers in the byte order of a file.

use bytemuck::Pod;

/// Plain data made of numbers, which a file stores in little-endian order.
pub(super) trait Wire: Pod {
    /// Returns the value with the bytes of every number reversed.
    fn swap_bytes(self) -> Self;

    /// Converts from the byte order of the file to that of this machine, or back.
    #[inline(always)]
    fn ordered(self) -> Self {
        if cfg!(target_endian = "big") { self.swap_bytes() } else { self }
    }
}

macro_rules! wire_number {
    ($($number:ty),*) => {$(
        impl Wire for $number {
            #[inline(always)]
            fn swap_bytes(self) -> $number {
                <$number>::swap_bytes(self)
            }
        }
    )*};
}
wire_number!(u8, u16, u32, u64);

/// Implements [`Wire`] for a struct, or also declares the struct, with the offset of each field, which is
/// part of the format.
macro_rules! wire_struct {
    ($name:ident { $($field:ident),* }) => {
        impl Wire for $name {
            #[inline(always)]
            fn swap_bytes(self) -> $name {
                $name { $($field: Wire::swap_bytes(self.$field)),* }
            }
        }
    };
    ($(#[$about:meta])* struct $name:ident: $size:literal {
        $($(#[$note:meta])* $at:literal $field:ident: $type:ty,)*
    }) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
        #[repr(C)]
        pub(super) struct $name {
            $($(#[$note])* pub $field: $type,)*
        }

        wire_struct!($name { $($field),* });

        const _: () = {
            assert!(size_of::<$name>() == $size && align_of::<$name>() == 8);
            $(assert!(core::mem::offset_of!($name, $field) == $at);)*
        };
    };
}
pub(super) use wire_struct;

impl<T: Wire, const N: usize> Wire for [T; N]
where
    [T; N]: Pod,
{
    #[inline(always)]
    fn swap_bytes(self) -> [T; N] {
        self.map(T::swap_bytes)
    }
}

/// Iterates over the numbers in `bytes`, in the byte order of this machine; any alignment is allowed.
pub(super) fn elements<T: Wire>(bytes: &[u8]) -> impl Iterator<Item = T> {
    bytes.chunks_exact(size_of::<T>()).map(|raw| bytemuck::pod_read_unaligned::<T>(raw).ordered())
}

/// Reverses the bytes of every number: from the file's byte order to that of a big-endian machine, or back.
pub(super) fn swap_all<T: Wire>(bytes: &mut [u8]) {
    for raw in bytes.chunks_exact_mut(size_of::<T>()) {
        let value = bytemuck::pod_read_unaligned::<T>(raw).swap_bytes();
        raw.copy_from_slice(bytemuck::bytes_of(&value));
    }
}

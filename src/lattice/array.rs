//! Arrays of a few elements, one by one.

/// Arrays that can be changed element by element: `[a, b].each(of)` is `[of(a), of(b)]`. (It replaces
/// `array::map`, which makes ten times as many instructions to compile, and was an eighth of the machine code
/// of this library before it was optimised.)
pub(crate) trait Each {
    /// The elements.
    type Item;
    /// An array as long as this one.
    type Of<U>;

    /// Returns the array of the results.
    fn each<U>(self, of: impl FnMut(Self::Item) -> U) -> Self::Of<U>;
}

macro_rules! each {
    ($($length:literal: $($item:ident)*;)*) => {$(
        impl<T> Each for [T; $length] {
            type Item = T;
            type Of<U> = [U; $length];

            #[inline(always)]
            fn each<U>(self, mut of: impl FnMut(T) -> U) -> [U; $length] {
                let [$($item),*] = self;
                [$(of($item)),*]
            }
        }
    )*};
}

each! {
    1: a;
    2: a b;
    3: a b c;
    4: a b c d;
    5: a b c d e;
    6: a b c d e f;
    7: a b c d e f g;
    8: a b c d e f g h;
    9: a b c d e f g h i;
    10: a b c d e f g h i j;
    12: a b c d e f g h i j k l;
}

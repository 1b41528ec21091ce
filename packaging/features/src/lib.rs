//! Nothing: the manifest of this package is its purpose.

//! The table of diagnostic codes: one row a code, with the page that explains it.
//!
//! A code is stable: a row may be reworded, but its code is never given another meaning nor used
//! again. `E00xx` is text and grammar, `E01xx` names, `E02xx` types and units, `E03xx` statements,
//! structure and errors, `E04xx` reversal, `E05xx` files, `E06xx` forks, `E07xx` inversion; `W00xx`
//! warnings, `W04xx` those about reversal, `W05xx` about files, `W06xx` about forks. It knows
//! nothing of how a mistake is found or shown.

mod errors;
mod warnings;

use errors::errors;
use warnings::warnings;

/// Makes the type of all rows.
macro_rules! codes {
    ($($rows:tt)*) => { obverse_codes::table! { Code "A kind of diagnostic." $($rows)* } };
}

// The examples are whole programs: tests hold that the wrong one gets its code and no other, and
// that the right one gets none.
warnings! { errors codes }

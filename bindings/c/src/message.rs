//! A sentence in memory that is there already.

use core::ffi::c_char;
use core::fmt;

use crate::ft_status;

/// Bytes of a message, its closing zero included.
pub const FT_MESSAGE_BYTES: usize = 512;

/// Why a call failed. The caller owns it.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ft_error {
    /// What kind of failure.
    pub status: ft_status,
    /// A sentence that names what the caller wrote and how to mend it: UTF-8, closed by a zero, shortened to fit.
    pub message: [c_char; FT_MESSAGE_BYTES],
}

impl ft_error {
    /// Nothing failed.
    pub(crate) const fn none() -> Self {
        Self { status: ft_status::FT_OK, message: [0; FT_MESSAGE_BYTES] }
    }

    /// Of something that can be said; what does not fit is left out, at a whole character.
    pub(crate) fn of(status: ft_status, sentence: &impl fmt::Display) -> Self {
        let mut error = Self { status, ..Self::none() };
        let mut rest = Rest(&mut error.message);
        // Full is no fault.
        let _ = fmt::Write::write_fmt(&mut rest, format_args!("{sentence}"));
        error
    }
}

/// What is left of a buffer, of which the last byte stays zero.
struct Rest<'a>(&'a mut [c_char]);

impl fmt::Write for Rest<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let room = self.0.len().saturating_sub(1);
        let taken = text.floor_char_boundary(room);
        let buffer = core::mem::take(&mut self.0);
        let (now, later) = buffer.split_at_mut_checked(taken).unwrap_or_default();
        for (to, from) in now.iter_mut().zip(text.bytes()) {
            // A zero within a text would end it.
            *to = if from == 0 { b'?' } else { from }.cast_signed() as c_char;
        }
        self.0 = later;
        if taken == text.len() { Ok(()) } else { Err(fmt::Error) }
    }
}

#[cfg(test)]
mod tests {
    use core::ffi::CStr;

    use super::*;

    fn text(error: &ft_error) -> String {
        // SAFETY: the message is closed by a zero within its bytes: what these tests are about.
        unsafe { CStr::from_ptr(error.message.as_ptr()) }.to_str().unwrap().to_owned()
    }

    #[test]
    fn a_message_is_closed_and_cut_at_a_character() {
        assert_eq!(text(&ft_error::none()), "");
        assert_eq!(text(&ft_error::of(ft_status::FT_BAD_SCENE, &"a\0b")), "a?b");
        for length in [0, 510, 511, 512, 600] {
            let error = ft_error::of(ft_status::FT_BAD_SCENE, &"x".repeat(length));
            assert_eq!(text(&error).len(), length.min(511));
            assert_eq!(error.message[511], 0);
        }
        // An umlaut takes two bytes, of which only one would fit.
        let umlauts = text(&ft_error::of(ft_status::FT_OK, &format!("x{}", "ä".repeat(300))));
        assert_eq!(umlauts, format!("x{}", "ä".repeat(255)));
        let cut = text(&ft_error::of(ft_status::FT_OK, &"ä".repeat(300)));
        assert_eq!(cut, "ä".repeat(255));
    }
}

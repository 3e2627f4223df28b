#pragma once
// Says which words of an OBJ file its parser reads rightly: it makes a zero of what it does not understand. Internal to the
// module.
#include <optional>
#include <string>
#include <string_view>

namespace echopath {

// Takes the next word, between spaces and tabs, off the beginning of `text`; returns an empty one at its end.
std::string_view take_word(std::string_view& text);

// Returns the double nearest to a decimal number, none for any other word and for a number that no double comes near.
std::optional<double> number_of(std::string_view word);

// Returns whether a word is NaN or infinite, in letters of either case and with a sign or without.
bool is_not_finite(std::string_view word);

// Returns whether a word is a corner of a face: v, v/vt, v//vn or v/vt/vn, each a whole number of 32 bits.
bool is_corner(std::string_view word);

// Returns whether a text is UTF-8 (RFC 3629) without NUL, as names must be.
bool is_name(std::string_view text);

// Returns the UTF-8 of a text in Latin-1, as older programs write names.
std::string utf8_of_latin1(std::string_view text);

}  // namespace echopath

#include "echopath/scene/readers/obj_words.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <system_error>

namespace echopath {
namespace {

template <class Number>
bool reads_whole(std::string_view word, Number& value) {
  const char *const first = word.data(), *const last = first + word.size();
  const auto [end, error] = std::from_chars(first, last, value);
  return error == std::errc() && end == last;
}

// Returns the number of bytes of the character that begins `text`, 0 for none: the ranges of its first two bytes say it.
size_t character_length(std::string_view text) {
  const auto byte = [&](size_t i) { return i < text.size() ? static_cast<uint8_t>(text[i]) : uint8_t{0}; };
  const auto is_between = [&](size_t i, int low, int high) { return byte(i) >= low && byte(i) <= high; };
  if (is_between(0, 0x01, 0x7F)) return 1;
  if (is_between(0, 0xC2, 0xDF)) return is_between(1, 0x80, 0xBF) ? 2 : 0;
  if (is_between(0, 0xE0, 0xEF)) {
    const bool is_valid = is_between(1, byte(0) == 0xE0 ? 0xA0 : 0x80, byte(0) == 0xED ? 0x9F : 0xBF);
    return is_valid && is_between(2, 0x80, 0xBF) ? 3 : 0;
  }
  if (!is_between(0, 0xF0, 0xF4)) return 0;
  const bool is_valid = is_between(1, byte(0) == 0xF0 ? 0x90 : 0x80, byte(0) == 0xF4 ? 0x8F : 0xBF);
  return is_valid && is_between(2, 0x80, 0xBF) && is_between(3, 0x80, 0xBF) ? 4 : 0;
}

}  // namespace

std::string_view take_word(std::string_view& text) {
  constexpr std::string_view kBlanks = " \t";
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
  text.remove_prefix(word.size());
  return word;
}

std::optional<double> number_of(std::string_view word) {
  if (word.find_first_not_of("0123456789+-.eE") != std::string_view::npos) return std::nullopt;
  if (word.starts_with("+-")) return std::nullopt;
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  return reads_whole(word, value) ? std::optional(value) : std::nullopt;
}

bool is_not_finite(std::string_view word) {
  if (word.starts_with('-') || word.starts_with('+')) word.remove_prefix(1);
  std::string letters(word);
  for (char& letter : letters) letter = static_cast<char>(letter | 0x20);
  return letters == "nan" || letters == "inf" || letters == "infinity";
}

bool is_corner(std::string_view word) {
  for (int part = 0; part < 3; ++part) {
    const size_t slash = word.find('/');
    const std::string_view digits = word.substr(0, slash);
    int index = 0;
    if (!reads_whole(digits, index) && (part == 0 || !digits.empty())) return false;
    if (slash == std::string_view::npos) return true;
    word.remove_prefix(slash + 1);
  }
  return false;
}

bool is_name(std::string_view text) {
  while (!text.empty()) {
    const size_t length = character_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string utf8_of_latin1(std::string_view text) {
  std::string utf8;
  for (const char letter : text) {
    const auto code = static_cast<uint8_t>(letter);
    if (code >= 0x80) utf8 += static_cast<char>(0xC0 | (code >> 6));
    utf8 += static_cast<char>(code >= 0x80 ? 0x80 | (code & 0x3F) : code);
  }
  return utf8;
}

}  // namespace echopath

#include "echopath/scene/readers/text_lines.h"

#include <algorithm>
#include <cctype>
#include <optional>

#include "echopath/base/errors.h"
#include "echopath/scene/readers/obj_words.h"

namespace echopath {

bool is_word(std::string_view word, std::string_view keyword) {
  return std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(),
                    [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  return text.substr(0, text.find_last_not_of(" \t") + 1);
}

bool TextLines::next() {
  while (at_ < bytes_.size()) {
    const size_t end = std::min(bytes_.find_first_of("\r\n", at_), bytes_.size());
    const std::string_view line = std::string_view(bytes_).substr(at_, end - at_);
    const bool is_pair = end + 1 < bytes_.size() && bytes_[end] == '\r' && bytes_[end + 1] == '\n';
    at_ = end + (is_pair ? 2 : 1);
    ++line_;
    text_ = trimmed(line.substr(0, line.find('#')));
    if (!text_.empty()) return true;
  }
  text_ = {};
  return false;
}

Vec3 TextLines::point(std::string_view& rest) const {
  Vec3 point;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const std::string_view word = take_word(rest);
    if (word.empty()) refuse("a vertex needs 3 numbers: '" + std::string(text_.substr(0, 80)) + "'");
    const std::optional<double> number = number_of(word);
    if (!number) refuse("not a number: '" + std::string(word.substr(0, 80)) + "'");
    point[axis] = *number;
  }
  return point;
}

void TextLines::refuse(const std::string& what) const {
  throw FileError(name_ + ", line " + std::to_string(line_) + ": " + what);
}

}  // namespace echopath

#pragma once
// Reads the lines of a mesh file that is text; errors name them. Internal to the module.
#include <cstdint>
#include <string>
#include <string_view>

#include "echopath/scene/mesh/mesh.h"

namespace echopath {

// Returns whether a word is a keyword, which is given in small letters; case does not count.
bool is_word(std::string_view word, std::string_view keyword);

// Returns a text without spaces and tabs at its ends.
std::string_view trimmed(std::string_view text);

class TextLines {
 public:
  // `bytes` and `name`, what messages call the file, must outlive this.
  TextLines(const std::string& bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  // Goes on to the next line that is neither empty nor a comment, from `#` to its end; returns false behind the last one.
  bool next();
  std::string_view text() const { return text_; }  // of the line, without its comment and spaces at its ends

  // Returns the point that the next three words of `rest` give, and takes them off.
  Vec3 point(std::string_view& rest) const;

  // Raises FileError naming the file and the line.
  [[noreturn]] void refuse(const std::string& what) const;

 private:
  const std::string& bytes_;
  const std::string& name_;
  std::string_view text_;
  size_t at_ = 0;
  int64_t line_ = 0;
};

}  // namespace echopath

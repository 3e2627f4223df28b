#include <charconv>
#include <iterator>
#include <string_view>
#include <utility>

#include "echopath/scene/readers/obj_words.h"
#include "echopath/scene/readers/soup.h"
#include "echopath/scene/readers/text_lines.h"

namespace echopath {
namespace {

// Reads an Object File Format of Geomview: a keyword, three counts, a line per vertex, a line per face.
class OffText {
 public:
  OffText(const std::string& bytes, const std::string& name) : lines_(bytes, name) {}

  void read() {
    read_head();
    for (uint64_t i = 0; i < num_vertices_; ++i) read_vertex(i);
    soup.group_names.emplace_back();
    for (uint64_t i = 0; i < num_faces_; ++i) read_face(i);
  }

  Soup soup;

 private:
  // Files of ModelNet have their counts right behind the keyword, as in "OFF490 518 0".
  void read_head() {
    if (!lines_.next()) lines_.refuse("the file is empty");
    std::string_view rest = lines_.text();
    const size_t keyword = rest.find("OFF");
    const bool is_known =
        keyword != std::string_view::npos && rest.substr(0, keyword).find_first_not_of("STCN") == std::string_view::npos;
    if (!is_known) lines_.refuse("the file must begin with OFF, in three dimensions");
    rest.remove_prefix(keyword + 3);
    if (is_word(trimmed(rest), "binary")) lines_.refuse("binary OFF files are not read, only text");
    if (rest.empty()) rest = next_line("its counts");
    num_vertices_ = whole(rest, "the number of vertices");
    num_faces_ = whole(rest, "the number of faces");
  }

  void read_vertex(uint64_t number) {
    std::string_view rest = next_line("vertex " + std::to_string(number) + " of " + std::to_string(num_vertices_));
    soup.vertices.push_back(lines_.point(rest));  // colours and normals behind it are left
  }

  void read_face(uint64_t number) {
    std::string_view rest = next_line("face " + std::to_string(number) + " of " + std::to_string(num_faces_));
    const uint64_t count = whole(rest, "the number of corners");
    if (count < 3) lines_.refuse("a face needs 3 corners, it has " + std::to_string(count));
    corners_.clear();
    for (uint64_t i = 0; i < count; ++i) {
      const uint64_t vertex = whole(rest, "a corner");
      if (vertex >= num_vertices_) {
        lines_.refuse("vertex " + std::to_string(vertex) + " does not exist, there are " + std::to_string(num_vertices_));
      }
      corners_.push_back(static_cast<uint32_t>(vertex));
    }
    soup.add_polygon(corners_, 0);
  }

  std::string_view next_line(const std::string& what) {
    if (!lines_.next()) lines_.refuse("the file ends too early, before " + what);
    return lines_.text();
  }

  uint64_t whole(std::string_view& rest, const std::string& what) const {
    const std::string_view word = take_word(rest);
    uint32_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || error != std::errc() || end != word.data() + word.size()) {
      lines_.refuse(what + " must be a whole number, got '" + std::string(word.substr(0, 80)) + "'");
    }
    return value;
  }

  TextLines lines_;
  std::vector<uint32_t> corners_;
  uint64_t num_vertices_ = 0, num_faces_ = 0;
};

}  // namespace

Soup read_off(std::istream& file, const std::string& name) {
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  OffText text(bytes, name);
  text.read();
  return std::move(text.soup);
}

}  // namespace echopath

#include <tiny_obj_loader.h>

#include <algorithm>
#include <fstream>
#include <istream>
#include <limits>
#include <streambuf>
#include <string_view>
#include <type_traits>
#include <utility>

#include "echopath/base/errors.h"
#include "echopath/scene/readers/soup.h"

namespace echopath {
namespace {

static_assert(std::is_same_v<tinyobj::real_t, double>, "coordinates in float lose half a metre at 5.4e6 m");

[[noreturn]] void fail(const std::string& path, int64_t line, const std::string& what) {
  throw FileError(path + ", line " + std::to_string(line) + ": " + what);
}

// Hands a file to the parser line by line, so that errors can name the line. It refuses vertices and faces that the parser
// would read as zeros, and mends what the parser does not know: continued lines, comments behind values, a bare `g`.
class ObjLines : public std::streambuf {
 public:
  explicit ObjLines(std::string path) : path_(std::move(path)), file_(path_, std::ios::binary) {
    if (!file_) throw FileError(path_ + ": cannot be opened");
  }
  int64_t line() const { return line_; }

 protected:
  int_type underflow() override {
    if (!next_line()) return traits_type::eof();
    setg(text_.data(), text_.data(), text_.data() + text_.size());
    return traits_type::to_int_type(text_.front());
  }

 private:
  bool next_line() {
    text_.clear();
    std::string part;
    bool continued = true, any = false;
    while (continued && std::getline(file_, part)) {
      any = true;
      ++line_;
      while (!part.empty() && (part.back() == '\r' || part.back() == ' ')) part.pop_back();
      continued = !part.empty() && part.back() == '\\';
      if (continued) part.back() = ' ';
      text_ += part;
    }
    if (!any) return false;
    check_and_mend();
    text_ += '\n';
    return true;
  }

  void check_and_mend() {
    const size_t begin = std::min(text_.find_first_not_of(" \t"), text_.size());
    const std::string_view statement = std::string_view(text_).substr(begin);
    if (statement == "g") text_ += ' ';
    if (statement.size() < 2 || (statement[1] != ' ' && statement[1] != '\t')) return;
    if (statement[0] != 'v' && statement[0] != 'f') return;
    text_.resize(std::min(text_.find('#'), text_.size()));
    const std::string_view values = std::string_view(text_).substr(begin + 2);
    const bool is_vertex = statement[0] == 'v';
    const std::string_view allowed = is_vertex ? "0123456789+-.eE \t" : "0123456789-/ \t";
    if (values.find_first_not_of(allowed) != std::string_view::npos) fail(path_, line_, "not a number in '" + text_ + "'");
    if (count_words(values) < 3) {
      fail(path_, line_,
           std::string(is_vertex ? "a vertex needs 3 numbers" : "a face needs 3 corners") + ": '" + text_ + "'");
    }
  }

  static int count_words(std::string_view text) {
    int count = 0;
    bool inside = false;
    for (const char c : text) {
      const bool blank = c == ' ' || c == '\t';
      if (!blank && !inside) ++count;
      inside = !blank;
    }
    return count;
  }

  std::string path_, text_;
  std::ifstream file_;
  int64_t line_ = 0;
};

// Fills a soup by the parser's callbacks. A face belongs to its group or, without one, to its object; equal names are one
// group.
class ObjBuilder {
 public:
  ObjBuilder(const std::string& path, const ObjLines& lines) : path_(path), lines_(lines) {}

  static void vertex(void* self, double x, double y, double z, double) {
    auto& builder = *static_cast<ObjBuilder*>(self);
    const Vec3 point(x, y, z);
    if (!point.allFinite()) builder.refuse("a coordinate is out of range");
    builder.soup.vertices.push_back(point);
  }

  static void face(void* self, tinyobj::index_t* corners, int count) {
    auto& builder = *static_cast<ObjBuilder*>(self);
    builder.corners_.clear();
    for (int i = 0; i < count; ++i) builder.corners_.push_back(builder.vertex_index(corners[i].vertex_index));
    builder.soup.add_polygon(builder.corners_, builder.group_index());
  }

  static void group(void* self, const char** names, int count) {
    std::string& name = static_cast<ObjBuilder*>(self)->group_;
    name.clear();
    for (int i = 0; i < count; ++i) name.append(i > 0 ? "_" : "").append(names[i]);
  }

  static void object(void* self, const char* name) {
    auto& builder = *static_cast<ObjBuilder*>(self);
    builder.object_ = name;
    builder.object_.erase(0, builder.object_.find_first_not_of(" \t"));
    builder.group_.clear();
  }

  Soup soup;

 private:
  [[noreturn]] void refuse(const std::string& what) const { fail(path_, lines_.line(), what); }

  // OBJ counts from 1, and backwards from the latest vertex with negative numbers.
  uint32_t vertex_index(int64_t given) const {
    const auto count = static_cast<int64_t>(soup.vertices.size());
    const int64_t index = given > 0 ? given - 1 : count + given;
    if (given == 0 || index < 0 || index >= count) {
      refuse("vertex " + std::to_string(given) + " does not exist, there are " + std::to_string(count));
    }
    return static_cast<uint32_t>(index);
  }

  uint32_t group_index() {
    const std::string& name = group_.empty() ? object_ : group_;
    if (latest_ < soup.group_names.size() && soup.group_names[latest_] == name) return latest_;
    const auto found = std::find(soup.group_names.begin(), soup.group_names.end(), name);
    latest_ = static_cast<uint32_t>(found - soup.group_names.begin());
    if (found == soup.group_names.end()) soup.group_names.push_back(name);
    return latest_;
  }

  const std::string& path_;
  const ObjLines& lines_;
  std::string group_, object_;
  std::vector<uint32_t> corners_;
  uint32_t latest_ = std::numeric_limits<uint32_t>::max();
};

}  // namespace

Soup read_obj(const std::string& path) {
  ObjLines lines(path);
  std::istream stream(&lines);
  stream.exceptions(std::ios::badbit);  // an error raised in underflow must come out
  ObjBuilder builder(path, lines);
  tinyobj::callback_t callbacks;
  callbacks.vertex_cb = ObjBuilder::vertex;
  callbacks.index_cb = ObjBuilder::face;
  callbacks.group_cb = ObjBuilder::group;
  callbacks.object_cb = ObjBuilder::object;
  tinyobj::LoadObjWithCallback(stream, callbacks, &builder);
  return std::move(builder.soup);
}

}  // namespace echopath

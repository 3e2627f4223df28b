#include <tiny_obj_loader.h>

#include <algorithm>
#include <istream>
#include <limits>
#include <map>
#include <optional>
#include <streambuf>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "echopath/base/errors.h"
#include "echopath/scene/readers/obj_words.h"
#include "echopath/scene/readers/soup.h"
#include "echopath/scene/readers/text_lines.h"

namespace echopath {
namespace {

static_assert(std::is_same_v<tinyobj::real_t, double>, "coordinates in float lose half a metre at 5.4e6 m");

[[noreturn]] void fail(const std::string& path, int64_t line, const std::string& what) {
  throw FileError(path + ", line " + std::to_string(line) + ": " + what);
}

constexpr double kParserRounding = 1e-12;  // relative; the parser misreads numbers of hundreds of digits
constexpr double kSmallest = std::numeric_limits<double>::min();
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

// Hands a file to the parser line by line, so that errors can name the line. It refuses vertices and faces that the parser
// would read as zeros, and mends what the parser does not know: a byte-order mark, continued lines, comments behind values,
// a bare `g`.
class ObjLines : public std::streambuf {
 public:
  ObjLines(std::istream& file, const std::string& path) : path_(path), file_(file) {}
  int64_t line() const { return line_; }
  const Vec3& vertex() const { return vertex_; }  // of the latest such line, to the nearest double
  const std::vector<std::string>& material_files() const { return material_files_; }
  uint32_t smoothing() const { return smoothing_; }  // group of the latest line `s`, 0 for none

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
    while (continued && read_line(part)) {
      any = true;
      if (++line_ == 1) check_encoding(part);
      while (!part.empty() && part.back() == ' ') part.pop_back();
      continued = !part.empty() && part.back() == '\\';
      if (continued) part.back() = ' ';
      text_ += part;
    }
    if (!any) return false;
    check_and_mend();
    text_ += '\n';
    return true;
  }

  void check_encoding(std::string& first_line) const {
    for (const std::string_view mark : {"\xFF\xFE", "\xFE\xFF"}) {
      if (first_line.starts_with(mark)) fail(path_, line_, "must be UTF-8 or Latin-1 text, is UTF-16");
    }
    if (first_line.starts_with(kByteOrderMark)) first_line.erase(0, kByteOrderMark.size());
  }

  // Reads up to the end of a line as any system writes it, which is also where the parser ends one.
  bool read_line(std::string& part) {
    part.clear();
    std::streambuf& bytes = *file_.rdbuf();
    const int_type end = traits_type::eof();
    int_type c = bytes.sbumpc();
    const bool any = c != end;
    for (; c != end && c != '\n' && c != '\r'; c = bytes.sbumpc()) part += traits_type::to_char_type(c);
    if (c == '\r' && bytes.sgetc() == '\n') bytes.sbumpc();
    return any;
  }

  void check_and_mend() {
    const size_t begin = std::min(text_.find_first_not_of(" \t"), text_.size());
    const std::string_view statement = std::string_view(text_).substr(begin);
    const std::string_view keyword = statement.substr(0, statement.find_first_of(" \t"));
    const bool has_name = keyword == "g" || keyword == "o" || keyword == "usemtl" || keyword == "mtllib";
    if (has_name && !is_name(statement)) {
      if (text_.find('\0') != std::string::npos) fail(path_, line_, "a name must not hold NUL");
      text_ = utf8_of_latin1(text_);
      check_and_mend();
      return;
    }
    if (keyword == "s") smoothing_ = smoothing_of(statement.substr(1));
    if (keyword == "mtllib") material_files_.emplace_back(trimmed(statement.substr(keyword.size())));
    if (statement == "g") {
      text_ += ' ';  // which may move the text away from its views
      return;
    }
    const bool is_vertex = keyword == "v";
    if (!is_vertex && keyword != "f") return;
    text_.resize(std::min(text_.find('#'), text_.size()));
    const std::string_view values = std::string_view(text_).substr(std::min(begin + 1, text_.size()));
    if (is_vertex) check_vertex(values);
    else check_face(values);
  }

  // Returns the group that a line `s` names, 1 for `on`; anything else but a number, such as `off`, names none.
  static uint32_t smoothing_of(std::string_view values) {
    const std::string_view word = take_word(values);
    if (word == "on") return 1;
    const std::optional<double> number = number_of(word);
    return number && *number >= 1.0 && *number < 4e9 ? static_cast<uint32_t>(*number) : 0;
  }

  void check_vertex(std::string_view values) {
    Eigen::Index count = 0;
    for (std::string_view word = take_word(values); !word.empty(); word = take_word(values)) {
      const std::optional<double> number = number_of(word);
      const bool may_be_any = count >= 3 && is_not_finite(word);  // of a colour
      if (!number && !may_be_any) refuse("not a number", word);
      if (count < 3) vertex_[count] = *number;
      ++count;
    }
    if (count < 3) fail(path_, line_, "a vertex needs 3 numbers: '" + text_ + "'");
  }

  void check_face(std::string_view values) const {
    int64_t count = 0;
    for (std::string_view word = take_word(values); !word.empty(); word = take_word(values)) {
      if (!is_corner(word)) refuse("not a number of a corner", word);
      ++count;
    }
    if (count < 3) fail(path_, line_, "a face needs 3 corners: '" + text_ + "'");
  }

  [[noreturn]] void refuse(const std::string& what, std::string_view word) const {
    fail(path_, line_, what + ": '" + std::string(word) + "' in '" + text_ + "'");
  }

  const std::string& path_;
  std::istream& file_;
  std::string text_;
  Vec3 vertex_ = Vec3::Zero();
  std::vector<std::string> material_files_;  // as `mtllib` lines give them, which may be several names
  int64_t line_ = 0;
  uint32_t smoothing_ = 0;
};

// Fills a soup by the parser's callbacks. A face belongs to its group within its object, or to the object where there is no
// group; groups of equal names are one within an object.
class ObjBuilder {
 public:
  ObjBuilder(const std::string& path, const ObjLines& lines) : path_(path), lines_(lines) {}

  static void vertex(void* self, double x, double y, double z, double) {
    auto& builder = *static_cast<ObjBuilder*>(self);
    const Vec3 point(x, y, z), &exact = builder.lines_.vertex();
    const bool is_near =
        ((point - exact).cwiseAbs().array() <= kParserRounding * exact.cwiseAbs().array() + kSmallest).all();
    if (!is_near) builder.refuse("a coordinate is out of range, or has hundreds of digits");
    builder.soup.vertices.push_back(point);
  }

  static void normal(void* self, double x, double y, double z) {
    static_cast<ObjBuilder*>(self)->soup.normals.emplace_back(x, y, z);
  }

  static void face(void* self, tinyobj::index_t* corners, int count) {
    auto& builder = *static_cast<ObjBuilder*>(self);
    builder.corners_.clear();
    builder.normals_.clear();
    for (int i = 0; i < count; ++i) {
      builder.corners_.push_back(builder.vertex_index(corners[i].vertex_index));
      builder.normals_.push_back(builder.normal_index(corners[i].normal_index));
    }
    if (builder.normals_.front() == kNoNormal) builder.normals_.clear();
    builder.soup.add_polygon(builder.corners_, builder.group_index(), builder.normals_);
    builder.soup.material.resize(builder.soup.triangles.size(), builder.material_index());
    builder.soup.smoothing.resize(builder.soup.triangles.size(), builder.lines_.smoothing());
  }

  static void material(void* self, const char* name, int) { static_cast<ObjBuilder*>(self)->material_ = trimmed(name); }

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
    const auto count = std::ssize(soup.vertices);
    const int64_t index = given > 0 ? given - 1 : count + given;
    if (given == 0 || index < 0 || index >= count) {
      refuse("vertex " + std::to_string(given) + " does not exist, there are " + std::to_string(count));
    }
    return static_cast<uint32_t>(index);
  }

  // Counts as vertices do; what does not exist is no normal, as surfaces are whole without.
  uint32_t normal_index(int64_t given) const {
    const auto count = std::ssize(soup.normals);
    const int64_t index = given > 0 ? given - 1 : count + given;
    return given == 0 || index < 0 || index >= count ? kNoNormal : static_cast<uint32_t>(index);
  }

  uint32_t group_index() {
    const bool is_within = !group_.empty() && group_ != object_;
    const auto [entry, added] =
        index_of_.try_emplace({is_within ? object_ : "", is_within ? group_ : object_}, soup.group_names.size());
    if (added) {
      soup.object_names.push_back(entry->first.first);
      soup.group_names.push_back(entry->first.second);
    }
    return static_cast<uint32_t>(entry->second);
  }

  uint32_t material_index() {
    const auto [entry, added] = index_of_material_.try_emplace(material_, soup.material_names.size());
    if (added) soup.material_names.push_back(material_);
    return static_cast<uint32_t>(entry->second);
  }

  const std::string& path_;
  const ObjLines& lines_;
  std::string group_, object_, material_;
  std::vector<uint32_t> corners_, normals_;
  std::map<std::pair<std::string, std::string>, size_t> index_of_;  // of the names of object and group
  std::unordered_map<std::string, size_t> index_of_material_;       // of the materials' names
};

}  // namespace

Soup read_obj(std::istream& file, const std::string& name) {
  ObjLines lines(file, name);
  std::istream stream(&lines);
  stream.exceptions(std::ios::badbit);  // an error raised in underflow must come out
  ObjBuilder builder(name, lines);
  tinyobj::callback_t callbacks;
  callbacks.vertex_cb = ObjBuilder::vertex;
  callbacks.normal_cb = ObjBuilder::normal;
  callbacks.index_cb = ObjBuilder::face;
  callbacks.group_cb = ObjBuilder::group;
  callbacks.object_cb = ObjBuilder::object;
  callbacks.usemtl_cb = ObjBuilder::material;
  tinyobj::LoadObjWithCallback(stream, callbacks, &builder);
  builder.soup.material_files = lines.material_files();
  return std::move(builder.soup);
}

}  // namespace echopath

#include "echopath/scene/readers/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>
#include <utility>

#include "echopath/base/errors.h"

namespace echopath {
namespace {

// clang-format off
constexpr std::array<std::pair<const char*, PlyType>, 16> kTypes = {{
    {"char", PlyType::kInt8}, {"int8", PlyType::kInt8}, {"uchar", PlyType::kUint8}, {"uint8", PlyType::kUint8},
    {"short", PlyType::kInt16}, {"int16", PlyType::kInt16}, {"ushort", PlyType::kUint16}, {"uint16", PlyType::kUint16},
    {"int", PlyType::kInt32}, {"int32", PlyType::kInt32}, {"uint", PlyType::kUint32}, {"uint32", PlyType::kUint32},
    {"float", PlyType::kFloat32}, {"float32", PlyType::kFloat32}, {"double", PlyType::kFloat64},
    {"float64", PlyType::kFloat64},
}};
// clang-format on

class HeaderParser {
 public:
  HeaderParser(std::istream& stream, const std::string& path) : stream_(stream), path_(path) {}

  PlyHeader parse() {
    if (next_line() != "ply") refuse("a PLY file begins with the line 'ply'");
    while (next_line() != "end_header") statement();
    if (!has_format_) refuse("the header has no line 'format'");
    return std::move(header_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw FileError(path_ + ", line " + std::to_string(header_.num_lines) + ": " + what);
  }

  const std::string& next_line() {
    ++header_.num_lines;
    if (!std::getline(stream_, line_)) refuse("the header ends without 'end_header'");
    while (!line_.empty() && (line_.back() == '\r' || line_.back() == ' ')) line_.pop_back();
    words_.assign({});
    std::istringstream text(line_);
    for (std::string word; text >> word;) words_.push_back(word);
    return line_;
  }

  void statement() {
    const std::string keyword = words_.empty() ? "comment" : words_[0];
    if (keyword == "comment" || keyword == "obj_info") return;
    if (keyword == "format") return format();
    if (keyword == "element") return element();
    if (keyword == "property") return property();
    refuse("unknown keyword '" + keyword + "'");
  }

  void format() {
    const std::string name = words_.size() == 3 ? words_[1] : "";
    if (name == "ascii") header_.format = PlyFormat::kAscii;
    else if (name == "binary_little_endian") header_.format = PlyFormat::kLittleEndian;
    else if (name == "binary_big_endian") header_.format = PlyFormat::kBigEndian;
    else refuse("unknown format: '" + line_ + "'");
    if (words_[2] != "1.0") refuse("only version 1.0 is known: '" + line_ + "'");
    has_format_ = true;
  }

  void element() {
    if (words_.size() != 3) refuse("an element needs a name and a count: '" + line_ + "'");
    PlyElement element;
    element.name = words_[1];
    const std::string& count = words_[2];
    const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    const bool whole = error == std::errc() && end == count.data() + count.size();
    if (!whole || element.count < 0) refuse("a count must be a whole number from 0: '" + line_ + "'");
    header_.elements.push_back(std::move(element));
  }

  void property() {
    if (header_.elements.empty()) refuse("a property before the first element");
    PlyProperty property;
    property.is_list = words_.size() == 5 && words_[1] == "list";
    if (!property.is_list && words_.size() != 3) refuse("a property needs a type and a name: '" + line_ + "'");
    property.type = type(words_[words_.size() - 2]);
    property.name = words_.back();
    if (property.is_list) property.count_type = type(words_[2]);
    header_.elements.back().properties.push_back(std::move(property));
  }

  PlyType type(const std::string& name) const {
    const auto found = std::ranges::find_if(kTypes, [&](const auto& known) { return name == known.first; });
    if (found == kTypes.end()) refuse("unknown type '" + name + "'");
    return found->second;
  }

  std::istream& stream_;
  const std::string& path_;
  std::string line_;
  std::vector<std::string> words_;
  PlyHeader header_;
  bool has_format_ = false;
};

}  // namespace

int PlyElement::find(const std::vector<std::string>& names) const {
  for (size_t i = 0; i < properties.size(); ++i) {
    if (std::ranges::find(names, properties[i].name) != names.end()) return static_cast<int>(i);
  }
  return -1;
}

PlyHeader read_ply_header(std::istream& stream, const std::string& path) { return HeaderParser(stream, path).parse(); }

}  // namespace echopath

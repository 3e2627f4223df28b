#pragma once
// Mesh files of a test: what is read from them, and how wrong ones are refused.
#include <initializer_list>
#include <string>
#include <vector>

#include "cpp/support/expect_error.h"
#include "echopath/base/errors.h"
#include "echopath/scene/readers/readers.h"
#include "temporary_file.h"

namespace echopath::test {

inline std::vector<NamedMesh> read_meshes(const std::string& name, const std::string& content, double unit = 1.0) {
  const TemporaryFile file(name, content);
  return load_meshes(file.path(), unit);
}

// Expects a FileError that names the file and holds the pieces, of all its meshes and of it as one mesh.
inline void expect_refused(const std::string& name, const std::string& content, std::initializer_list<std::string> pieces) {
  const TemporaryFile file(name, content);
  for (const auto& pattern : {std::initializer_list<std::string>{"echopath_" + name}, pieces}) {
    expect_error<FileError>([&] { load_meshes(file.path()); }, pattern);
    expect_error<FileError>([&] { load_mesh(file.path()); }, pattern);
  }
}

}  // namespace echopath::test

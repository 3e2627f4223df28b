#include <pybind11/pybind11.h>

#include <algorithm>
#include <memory>
#include <unordered_map>

#include "echopath/scene/mesh/mesh.h"

namespace echopath::bindings {
namespace {

namespace py = pybind11;

// Keeps a value for each mesh as long as the mesh lives, whichever Python objects stand for it meanwhile.
class MeshTable {
 public:
  // Returns what is kept for the mesh, or `otherwise`.
  py::object get(const std::shared_ptr<Mesh>& mesh, py::object otherwise) const {
    const auto found = entries_.find(mesh.get());
    // An entry of a mesh that is gone says nothing of one that has its address now.
    return found == entries_.end() || found->second.mesh.expired() ? otherwise : found->second.value;
  }
  void set(const std::shared_ptr<Mesh>& mesh, py::object value) {
    if (entries_.size() >= size_to_clean_) clean();
    entries_.insert_or_assign(mesh.get(), Entry{mesh, std::move(value)});
  }
  size_t size() {
    clean();
    return entries_.size();
  }

 private:
  static constexpr size_t kMinSizeToClean = 64;
  struct Entry {
    std::weak_ptr<const Mesh> mesh;
    py::object value;
  };

  void clean() {
    std::erase_if(entries_, [](const auto& entry) { return entry.second.mesh.expired(); });
    size_to_clean_ = std::max(kMinSizeToClean, 2 * entries_.size());
  }

  std::unordered_map<const Mesh*, Entry> entries_;
  size_t size_to_clean_ = kMinSizeToClean;
};

}  // namespace

void bind_mesh_table(py::module_& m) {
  py::class_<MeshTable>(m, "MeshTable", "Keeps a value for each Mesh while it lives, no part of the public interface.")
      .def(py::init<>())
      .def("get", &MeshTable::get, py::arg("mesh"), py::arg("otherwise"), "What is kept for the mesh, or `otherwise`.")
      .def("set", &MeshTable::set, py::arg("mesh"), py::arg("value"), "Keeps a value for the mesh.")
      .def("__len__", &MeshTable::size, "Number of meshes that live and have a value.");
}

}  // namespace echopath::bindings

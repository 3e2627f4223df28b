#include "values/held_object.h"

#include <mutex>
#include <utility>
#include <vector>

namespace echopath::bindings {
namespace {

// Objects whose holders are gone. It is never destroyed: threads may let go of holders while the process ends.
struct Released {
  std::mutex mutex;
  std::vector<PyObject*> objects;
};

Released& released() {
  static auto* const kReleased = new Released;
  return *kReleased;
}

void let_go(const void* object) {
  const std::lock_guard lock(released().mutex);
  released().objects.push_back(static_cast<PyObject*>(const_cast<void*>(object)));
}

// The lock is not held while Python destroys an object, which may run code of its own.
void give_back() {
  std::vector<PyObject*> objects;
  {
    const std::lock_guard lock(released().mutex);
    objects = std::exchange(released().objects, {});
  }
  for (PyObject* const object : objects) Py_DECREF(object);
}

}  // namespace

std::shared_ptr<const void> hold(const pybind11::object& object) {
  give_back();
  if (object.is_none()) return nullptr;
  return {static_cast<const void*>(pybind11::object(object).release().ptr()), &let_go};
}

pybind11::object held(const std::shared_ptr<const void>& holder) {
  if (!holder) return pybind11::none();
  return pybind11::reinterpret_borrow<pybind11::object>(static_cast<PyObject*>(const_cast<void*>(holder.get())));
}

}  // namespace echopath::bindings

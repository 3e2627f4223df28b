#pragma once
// pybind11 has no holder of const objects.
#include <functional>
#include <memory>

namespace echopath::bindings {

// Returns the pointer as pybind11 can hold it; what it points to must be bound without any way to change it.
template <class T>
std::shared_ptr<T> shared(const std::shared_ptr<const T>& pointer) {
  return std::const_pointer_cast<T>(pointer);
}

// A getter of such a pointer, of a member or a method of Class.
template <class Class, class Member>
auto shared_of(Member Class::* member) {
  return [member](const Class& self) { return shared(std::invoke(member, self)); };
}

}  // namespace echopath::bindings

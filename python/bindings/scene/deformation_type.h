#pragma once
// Every file that shows a Deformation to Python includes this, so that all of them agree on its class there.
#include <pybind11/pybind11.h>

#include <typeinfo>

#include "echopath/motion/looped_sequence.h"

// A looped sequence is a VertexSequence in Python, with a period.
template <>
struct pybind11::polymorphic_type_hook<echopath::Deformation> {
  static const void* get(const echopath::Deformation* deformation, const std::type_info*& type) {
    if (!deformation) return nullptr;
    const bool is_looped = dynamic_cast<const echopath::LoopedSequence*>(deformation) != nullptr;
    type = is_looped ? &typeid(echopath::VertexSequence) : &typeid(*deformation);
    return dynamic_cast<const void*>(deformation);
  }
};

#pragma once
// Values and keywords of Python as error messages show them.
#include <pybind11/pybind11.h>

#include <string>
#include <string_view>

namespace echopath::bindings {

// A short text for `value` that never fails: numbers, text and None as Python writes them (long ones are cut, lone
// surrogates stand as their escapes), an array by its kind and shape, "float64 [5, 2]", and anything else by the name of its
// type.
std::string shown(pybind11::handle value);

// The characters of a str; lone surrogates stand as their escapes.
std::string escaped(pybind11::handle text);

// Raise TypeError or ValueError: "<argument>: <rule>, got <value>".
[[noreturn]] void refuse_type(std::string_view argument, std::string_view rule, pybind11::handle value);
[[noreturn]] void refuse_value(std::string_view argument, std::string_view rule, pybind11::handle value);

}  // namespace echopath::bindings

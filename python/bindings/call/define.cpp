#include "call/define.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "echopath/base/text/meant_name.h"

namespace echopath::bindings::detail {
namespace {

std::vector<std::string> names_of(const std::vector<Parameter>& parameters) {
  std::vector<std::string> names;
  for (const Parameter& each : parameters) names.push_back(each.name);
  return names;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string hint_of_keyword(const std::string& word, const std::vector<std::string>& names) {
  if (names.empty()) return ", it takes no arguments";
  const std::string meant = meant_name(word, names);
  return meant.empty() ? "; its arguments are " + joined(names) : ", the nearest right one is '" + meant + "'";
}

// Tells which of the arguments given has what the word names; "" where none has.
std::string hint_of_argument(const std::string& word, const py::kwargs& keywords) {
  for (const auto& [key, value] : keywords) {
    const bool is_list = py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value);
    if (is_list && py::len(value) == 0) continue;
    const py::object one = is_list ? py::object(value[py::int_(0)]) : py::reinterpret_borrow<py::object>(value);
    const py::type type = py::type::of(one);
    if (!py::hasattr(type, "replace") || PyUnicode_Check(one.ptr()) || !py::hasattr(type, word.c_str())) continue;
    return std::string("; it belongs to ") + (is_list ? "each " : "the ") + py::cast<std::string>(type.attr("__name__")) +
           " in '" + py::cast<std::string>(key) + "'";
  }
  return "";
}

// The parameters that may be given without their names.
std::vector<Parameter> by_place(const std::vector<Parameter>& parameters) {
  std::vector<Parameter> found;
  std::ranges::copy_if(parameters, std::back_inserter(found), [](const Parameter& each) { return !each.is_keyword_only; });
  return found;
}

// What is wrong with a call that does not fit the parameters.
std::string complaint(const std::vector<Parameter>& parameters, bool takes_keywords, const py::args& values,
                      const py::kwargs& keywords) {
  const std::vector<std::string> names = names_of(parameters);
  for (const auto& [key, value] : keywords) {
    const std::string word = escaped(key);
    if (takes_keywords || std::ranges::find(names, word) != names.end()) continue;
    const std::string of_argument = hint_of_argument(word, keywords);
    return "unknown keyword '" + word + "'" + (of_argument.empty() ? hint_of_keyword(word, names) : of_argument);
  }
  const std::vector<Parameter> placed = by_place(parameters);
  if (values.size() > placed.size()) {
    const std::string count = std::to_string(placed.size()) + (placed.size() == 1 ? " argument" : " arguments");
    const std::string rule = placed.empty() ? "takes no arguments without their names"
                                            : "takes at most " + count + " without names (" + joined(names_of(placed)) + ")";
    const std::string all = names.size() > placed.size() ? "; its arguments are " + joined(names) : "";
    return rule + ", got " + std::to_string(values.size()) + all;
  }
  for (size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& each = parameters[i];
    const bool has_value = i < values.size(), has_keyword = keywords.contains(each.name.c_str());
    if (has_value && has_keyword) return "argument '" + each.name + "' is given twice, by its place and by its name";
    if (each.is_required && !has_value && !has_keyword) return "argument '" + each.name + "' is missing";
  }
  return "is called on an object of another class";
}

PyCFunctionObject* function_of(py::handle scope, const char* name) {
  py::object bound = py::getattr(scope, name);
  if (PyInstanceMethod_Check(bound.ptr()))
    bound = py::reinterpret_borrow<py::object>(PyInstanceMethod_GET_FUNCTION(bound.ptr()));
  return reinterpret_cast<PyCFunctionObject*>(bound.ptr());
}

// The line in front of a docstring that Python shows as the signature and leaves out of the text.
std::string signature_line(const Callee& callee, const std::vector<Parameter>& parameters) {
  std::vector<std::string> words;
  if (callee.bound == Bound::kMethod) words.emplace_back("self");
  bool is_keyword_only = false;
  for (const Parameter& each : parameters) {
    if (each.is_keyword_only && !is_keyword_only) words.emplace_back("*");
    is_keyword_only = each.is_keyword_only;
    words.push_back(each.is_required ? each.name : each.name + "=" + each.default_text);
  }
  if (callee.takes_keywords) words.emplace_back("**changes");
  return std::string(callee.name) + "(" + joined(words) + ")\n--\n\n";
}

}  // namespace

void define_refusal(const Callee& defined, const Parameters& parameters) {
  const auto [scope, name, bound, takes_keywords] = defined;
  const char* text = function_of(scope, name)->m_ml->ml_doc;
  const std::string doc = signature_line(defined, parameters.list()) + (text ? text : "");
  const bool is_init = std::strcmp(name, "__init__") == 0;
  const std::string callee = is_init ? py::cast<std::string>(scope.attr("__name__")) : name;
  const auto refuse = [callee, list = parameters.list(), any = takes_keywords](const py::args& values,
                                                                               const py::kwargs& keywords) {
    throw py::type_error(callee + ": " + complaint(list, any, values, keywords));
  };
  // pybind11 tries the functions of one name in turn, so this one is asked only where the right one does not fit.
  const py::name named(name);
  const py::scope within(scope);
  const py::sibling first(py::getattr(scope, name));
  if (is_init) {
    py::cpp_function([refuse](py::detail::value_and_holder&, const py::args& values,
                              const py::kwargs& keywords) { refuse(values, keywords); },
                     named, py::is_method(scope), first, py::detail::is_new_style_constructor());
  } else if (bound == Bound::kMethod) {
    py::cpp_function(
        [refuse](const py::object&, const py::args& values, const py::kwargs& keywords) { refuse(values, keywords); }, named,
        py::is_method(scope), first);
  } else {
    py::cpp_function(refuse, named, within, first);
  }
  write_doc(scope, name, doc);
}

void write_doc(py::handle scope, const char* name, const std::string& doc) {
  PyCFunctionObject* function = function_of(scope, name);
  std::free(const_cast<char*>(function->m_ml->ml_doc));  // pybind11 owns this text and frees it
  function->m_ml->ml_doc = strdup(doc.c_str());
}

}  // namespace echopath::bindings::detail

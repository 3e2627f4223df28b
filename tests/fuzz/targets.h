#pragma once
// What is fed to the readers of files and texts: a target takes any bytes, and returns unless a reader does what it must
// not.
// It ends the process where a reader lets through what it should refuse, so that both libFuzzer and a test see it.
#include <array>
#include <string>
#include <string_view>

namespace echopath::fuzz {

// Reads mesh files. Each refuses by FileError, or gives meshes of finite vertices and indices that lead somewhere.
void feed_obj(std::string_view bytes);
void feed_ply(std::string_view bytes);
void feed_stl(std::string_view bytes);
void feed_off(std::string_view bytes);
// Reads a selection of paths. It is refused by invalid_argument, or its text reads back as the same text, and it compiles to
// an automaton that takes any path or refuses it.
void feed_expression(std::string_view bytes);

struct Target {
  std::string_view name;  // of its folder under tests/fuzz/corpus
  void (*feed)(std::string_view bytes);
};
constexpr std::array<Target, 5> kTargets = {
    {{"obj", feed_obj}, {"ply", feed_ply}, {"stl", feed_stl}, {"off", feed_off}, {"expression", feed_expression}}};

// Ends the process with a message unless `holds`.
void demand(bool holds, const std::string& what);

}  // namespace echopath::fuzz

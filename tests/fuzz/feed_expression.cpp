#include <optional>
#include <stdexcept>
#include <vector>

#include "echopath/label/expressions/automaton.h"
#include "echopath/label/expressions/selection_text.h"
#include "fuzz/targets.h"

namespace echopath::fuzz {
namespace {

const std::vector<std::string> kMeshes = {"wall", "floor", "street/car/wheel", "street/car/body", "pedestrian/arm_left"};
constexpr int kMostHits = 6;

template <class Work>
bool is_refused(const Work& work) {
  try {
    work();
  } catch (const std::invalid_argument& error) {
    demand(std::string_view(error.what()).starts_with("path expression: "), "an error says what it is about");
    return true;
  }
  return false;
}

void compile(std::string_view text) {
  std::optional<Automaton> automaton;
  const bool refused = is_refused([&] { automaton.emplace(parse_path_expression(text), kMeshes); });
  if (refused) return;
  std::vector<Hit> hits(kMostHits + Automaton::kOverread, Hit{0, 0, 0.0f, 0.0f});
  for (size_t i = 0; i < hits.size(); ++i) hits[i].mesh_id = static_cast<uint32_t>(i * i % kMeshes.size());
  for (int count = 1; count <= kMostHits; ++count) {
    for (const uint64_t diffuse : {uint64_t{0}, uint64_t{5}}) {
      demand(automaton->takes(hits.data(), count, diffuse) == automaton->takes_in_fours(hits.data(), count, diffuse),
             "both ways to match agree");
    }
  }
}

}  // namespace

void feed_expression(std::string_view bytes) {
  std::optional<Selection> selection;
  if (is_refused([&] { selection = parse_selection(bytes); })) return;
  const std::string text = selection->text();
  demand(parse_selection(text).text() == text, "a selection's text reads back as itself");
  compile(bytes);
}

}  // namespace echopath::fuzz

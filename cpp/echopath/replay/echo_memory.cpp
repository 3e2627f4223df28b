#include "echopath/replay/echo_memory.h"

#include <memory>
#include <utility>

#include "echopath/base/memory/kept_memory.h"

namespace echopath {
namespace {

constexpr size_t kBytesOfValue = sizeof(double) + sizeof(std::complex<double>);

struct SpareEchoes {
  Echoes echoes;

  // Counts the room for delays, because their number is that of the paths that were followed.
  size_t num_bytes() const { return echoes.delay.capacity() * kBytesOfValue; }
};

}  // namespace

Echoes take_echoes(size_t num_values) {
  Echoes echoes = std::move(KeptMemory::of_process().take<SpareEchoes>(num_values * kBytesOfValue)->echoes);
  echoes.delay.resize(num_values);
  echoes.amplitude.resize(num_values);
  return echoes;
}

void keep_echoes(std::span<const size_t> places, Echoes& echoes) {
  const auto count = static_cast<size_t>(echoes.num_echoes), num_nodes = echoes.delay.size() / count;
  for (size_t node = 0; node < num_nodes; ++node) {
    for (size_t i = 0; i < places.size(); ++i) {
      echoes.delay[node * places.size() + i] = echoes.delay[node * count + places[i]];
      echoes.amplitude[node * places.size() + i] = echoes.amplitude[node * count + places[i]];
    }
  }
  echoes.num_echoes = std::ssize(places);
  echoes.delay.resize(num_nodes * places.size());
  echoes.amplitude.resize(num_nodes * places.size());
}

void leave_echoes(std::span<Echoes> echoes) {
  for (Echoes& one : echoes) {
    auto spare = std::make_unique<SpareEchoes>();
    spare->echoes.delay = std::move(one.delay);
    spare->echoes.amplitude = std::move(one.amplitude);
    one = {};
    KeptMemory::of_process().leave(std::move(spare));
  }
}

}  // namespace echopath

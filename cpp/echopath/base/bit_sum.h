#pragma once
// Computes check sums of 64 bits, by which values are compared.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace echopath {

// Holds a check sum, which depends on all values added and on their order. Two different sequences have the same sum by
// chance once in 2^64. Source: each word goes through the finaliser of Steele, Lea, Flood 2014 (SplitMix).
class BitSum {
 public:
  template <class Value>
  void add(const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    for (size_t done = 0; done < sizeof(Value); done += sizeof(uint64_t)) {
      uint64_t word = 0;
      std::memcpy(&word, reinterpret_cast<const unsigned char*>(&value) + done,
                  std::min(sizeof(Value) - done, sizeof(word)));
      sum_ = mixed(sum_ ^ word);
    }
  }
  // Four sums run side by side, so that none waits for the product of the one before.
  void add_bytes(const void* bytes, size_t count) {
    const auto* from = static_cast<const unsigned char*>(bytes);
    constexpr size_t kLanes = 4, kStep = kLanes * sizeof(uint64_t);
    uint64_t sums[kLanes] = {1, 2, 3, 4};
    size_t done = 0;
    for (; done + kStep <= count; done += kStep) {
      uint64_t words[kLanes];
      std::memcpy(words, from + done, kStep);
      for (size_t k = 0; k < kLanes; ++k) sums[k] = mixed(sums[k] ^ words[k]);
    }
    for (; done < count; done += sizeof(uint64_t)) {
      uint64_t word = 0;
      std::memcpy(&word, from + done, std::min(count - done, sizeof(uint64_t)));
      sums[0] = mixed(sums[0] ^ word);
    }
    for (const uint64_t sum : sums) sum_ = mixed(sum_ ^ sum);
  }
  uint64_t value() const { return sum_; }

 private:
  static uint64_t mixed(uint64_t word) {
    word += 0x9E3779B97F4A7C15u;
    word = (word ^ (word >> 30)) * 0xBF58476D1CE4E5B9u;
    word = (word ^ (word >> 27)) * 0x94D049BB133111EBu;
    return word ^ (word >> 31);
  }

  uint64_t sum_ = 0;
};

}  // namespace echopath

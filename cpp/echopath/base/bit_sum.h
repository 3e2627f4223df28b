#pragma once
// Sums up bits so that things can be compared by 64 of them.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace echopath {

// Hangs on all values added and on their order. Two different sequences have the same sum by chance once in 2^64. Source: each
// word goes through the finaliser of Steele, Lea, Flood 2014 (SplitMix).
class BitSum {
 public:
  template <class Value>
  void add(const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    add_bytes(&value, sizeof(Value));
  }
  void add_bytes(const void* bytes, size_t count) {
    const auto* from = static_cast<const unsigned char*>(bytes);
    for (size_t done = 0; done < count; done += sizeof(uint64_t)) {
      uint64_t word = 0;
      std::memcpy(&word, from + done, std::min(count - done, sizeof(uint64_t)));
      add_word(word);
    }
  }
  uint64_t value() const { return sum_; }

 private:
  void add_word(uint64_t word) {
    sum_ = (sum_ ^ word) + 0x9E3779B97F4A7C15u;
    sum_ = (sum_ ^ (sum_ >> 30)) * 0xBF58476D1CE4E5B9u;
    sum_ = (sum_ ^ (sum_ >> 27)) * 0x94D049BB133111EBu;
    sum_ ^= sum_ >> 31;
  }

  uint64_t sum_ = 0;
};

}  // namespace echopath

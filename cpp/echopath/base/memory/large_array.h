#pragma once
// Allocates arrays of many megabytes.
#include <cstddef>
#include <vector>

namespace echopath {

// Asks the system for large pages behind these bytes, which should not have been touched yet: filling them then takes a
// hundredth of the page faults. Does nothing where there are none.
void prefer_large_pages(void* data, size_t num_bytes);

// Makes an empty vector `count` elements long.
template <class T>
void resize_large(std::vector<T>& values, size_t count) {
  values.reserve(count);
  prefer_large_pages(values.data(), count * sizeof(T));
  values.resize(count);
}

}  // namespace echopath

#pragma once
#include <gtest/gtest.h>

#include "echopath/base/threads/parallel.h"

namespace echopath::test {

// The work, a function without arguments, gives the same on one thread as on so many others. Returns what it gives.
template <class Work>
auto same_on_any_threads(const Work& work, std::initializer_list<int> others = {4}) {
  set_num_threads(1);
  const auto one = work();
  for (const int threads : others) {
    set_num_threads(threads);
    EXPECT_TRUE(work() == one) << threads << " threads";
  }
  set_num_threads(0);
  return one;
}

}  // namespace echopath::test

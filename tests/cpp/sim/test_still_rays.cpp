// Rays that the frames of a sequence share.
#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <thread>

#include "echopath/base/errors.h"
#include "echopath/sim/rays/still_rays.h"

namespace echopath::test_still_rays {
namespace {

constexpr std::chrono::seconds kHangs{60};  // by far more than what is waited for takes

StillRays rays_of(const std::string& name) {
  StillRays rays;
  rays.guide.shares[name] = 1.0;
  return rays;
}

// A thread that waited for the first one would wait for ever here.
TEST(KeptStillRays, NobodyWaitsWhileAnotherThreadFindsThem) {
  struct Shared {
    KeptStillRays kept;
    std::promise<void> goes_on;
    std::promise<std::shared_ptr<const StillRays>> of_first, of_second;
  };
  const auto shared = std::make_shared<Shared>();  // a thread that hangs keeps it
  std::thread([shared] {
    shared->of_first.set_value(shared->kept.get([&] {
      std::thread([shared] { shared->of_second.set_value(shared->kept.get([] { return rays_of("wall"); })); }).detach();
      shared->goes_on.get_future().wait();
      return rays_of("wall");
    }));
  }).detach();
  auto of_second = shared->of_second.get_future();
  ASSERT_EQ(of_second.wait_for(kHangs), std::future_status::ready);
  shared->goes_on.set_value();
  const auto first = shared->of_first.get_future().get(), second = of_second.get();
  EXPECT_TRUE(second->holds("wall"));
  EXPECT_EQ(first, second);  // which was there first serves all
}

TEST(KeptStillRays, AreLookedForAgainWhereThatFailed) {
  KeptStillRays kept;
  EXPECT_THROW(kept.get([]() -> StillRays { throw Cancelled(); }), Cancelled);
  EXPECT_TRUE(kept.get([] { return rays_of("wall"); })->holds("wall"));
  EXPECT_TRUE(kept.get([] { return rays_of("floor"); })->holds("wall"));
}

}  // namespace
}  // namespace echopath::test_still_rays

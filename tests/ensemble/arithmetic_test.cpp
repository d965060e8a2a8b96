// The fingerprint of the digits that a build computes.
#include "ensemble/arithmetic.hpp"

#include <gtest/gtest.h>

namespace carom {

using namespace ensemble;

namespace {

// The same of all compilers and on all processors. Where digits, or what digests are made of, are
// changed on purpose this number is, too, and ensembles of earlier builds cannot be continued.
TEST(Arithmetic, HasItsFingerprint) { EXPECT_EQ(arithmetic_fingerprint(), "b455fc2e0a025ff4"); }

}  // namespace
}  // namespace carom

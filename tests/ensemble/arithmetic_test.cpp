// The fingerprint of the digits that a build computes.
#include "ensemble/arithmetic.hpp"

#include <gtest/gtest.h>

namespace carom {
namespace {

// The same of all compilers and on all processors. Where digits are changed on purpose this number is, too, and nobody goes on
// with ensembles of earlier builds.
TEST(Arithmetic, HasItsFingerprint) { EXPECT_EQ(arithmetic_fingerprint(), "8b6d37b6e0d770e0"); }

}  // namespace
}  // namespace carom

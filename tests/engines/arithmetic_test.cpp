// The fingerprint of the digits that a build computes.
#include "engines/arithmetic.hpp"

#include <gtest/gtest.h>

namespace carom {

using namespace engines;

namespace {

// The same of all compilers and on all processors. Where digits, or what digests are made of, are
// changed on purpose this number is, too, and ensembles of earlier builds cannot be continued.
TEST(Arithmetic, HasItsFingerprint) { EXPECT_EQ(arithmetic_fingerprint(), "f0e0c20b783a96f8"); }

}  // namespace
}  // namespace carom

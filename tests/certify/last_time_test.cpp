// What would be in doubt after the last time is never asked, and ties that the orbit does not come
// to are not listed.
#include <gtest/gtest.h>

#include "certify/systems.hpp"

namespace carom {
namespace {

using tests::exactly;
using tests::Shaped;
using tests::task_of;

CertifiedEnd until(const ExactSystem& system, const std::string& t_max, int* attempts = nullptr) {
  CertifiedTask task = task_of(0, 20);
  task.t_max = exactly(t_max);
  CertifiedOrbit orbit(system, task);
  const CertifiedEnd end = orbit.finish();
  if (attempts != nullptr) *attempts = orbit.effort().attempts;
  return end;
}

void expect_stop(const CertifiedEnd& end, const char* x, const char* y) {
  EXPECT_EQ(end.fate, CertifiedFate::completed) << end.reason;
  EXPECT_EQ(end.collisions, 0u);
  EXPECT_TRUE(end.ties.empty());
  EXPECT_EQ(end.x.text(15), x);
  EXPECT_EQ(end.y.text(15), y);
}

TEST(LastTime, TheLastTimeMayComeBeforeACorner) {
  Shaped triangle = tests::shaped("triangle", {}, "0", "0");
  triangle.spec.points["points"] = {
      {exactly("1"), exactly("0")}, {exactly("-1"), exactly("2")}, {exactly("-1"), exactly("-3")}};
  const ExactSystem system = tests::system_of(triangle, {exactly("1"), exactly("0")});
  int attempts = 0;
  const CertifiedEnd end = until(system, "1/10", &attempts);
  EXPECT_EQ(end.fate, CertifiedFate::completed) << end.reason;
  EXPECT_EQ(end.collisions, 0u);
  EXPECT_EQ(attempts, 1);
  EXPECT_EQ(until(system, "1-1/10^40").fate, CertifiedFate::completed);
  EXPECT_EQ(until(system, "1").fate, CertifiedFate::singular);
  EXPECT_EQ(until(system, "1+1/10^40").fate, CertifiedFate::singular);
}

TEST(LastTime, TheLastTimeMayComeBeforeACornerWithALimit) {
  const Shaped square = tests::shaped("rectangle", {{"width", "1"}, {"height", "1"}}, "1/5", "1/5");
  const ExactSystem straight = tests::system_of(square, {exactly("3/5"), exactly("3/5")});
  expect_stop(until(straight, "sqrt(2)/100"), "0.210000000000000", "0.210000000000000");
  expect_stop(until(straight, "sqrt(2)*4/5-sqrt(2)/10^40"), "1.000000000000000",
              "1.000000000000000");
  EXPECT_EQ(until(straight, "sqrt(2)*4/5+1/10^40").ties.size(), 1u);
  EXPECT_EQ(until(straight, "sqrt(2)*4/5+1/10^40").collisions, 2u);
}

TEST(LastTime, TheLastTimeMayComeAlongACorridor) {
  Shaped torus = tests::shaped("sinai", {{"side", "1"}, {"radius", "1/5"}}, "1/10", "1/10");
  expect_stop(until(tests::system_of(torus, {exactly("1"), exactly("0")}), "5"),
              "5.100000000000000", "0.100000000000000");
  expect_stop(until(tests::system_of(torus, {exactly("1"), exactly("0")}), "20000"),
              "20000.100000000000000", "0.100000000000000");
  EXPECT_EQ(until(tests::system_of(torus, {exactly("1"), exactly("0")}), "10^6").fate,
            CertifiedFate::undecided);
  // Along its edge discs are touched after 0.4, 1.4 …
  torus.inside.y = exactly("3/10");
  const CertifiedEnd edge = until(tests::system_of(torus, {exactly("1"), exactly("0")}), "5");
  EXPECT_EQ(edge.fate, CertifiedFate::completed) << edge.reason;
  EXPECT_EQ(edge.collisions, 0u);
  EXPECT_EQ(edge.ties.size(), 5u);
}

// A disc is touched at the time 10.
TEST(LastTime, TheLastTimeMayComeBeforeATangency) {
  Shaped discs = tests::shaped("discs", {{"radius", "1"}}, "0", "0");
  discs.spec.points["centers"] = {{exactly("10"), exactly("1")}, {exactly("20"), exactly("0")}};
  const ExactSystem system = tests::system_of(discs, {exactly("1"), exactly("0")});
  for (const auto& [t_max, ties] :
       {std::pair{"1", 0u}, {"10-1/10^25", 0u}, {"10", 1u}, {"10+1/10^25", 1u}, {"15", 1u}}) {
    const CertifiedEnd end = until(system, t_max);
    EXPECT_EQ(end.fate, CertifiedFate::completed) << end.reason;
    EXPECT_EQ(end.collisions, 0u);
    EXPECT_EQ(end.ties.size(), ties) << t_max;
  }
  EXPECT_EQ(until(system, "25").ties.size(), 1u);
  EXPECT_EQ(until(system, "30").ties.size(), 2u);  // on the way back
}

}  // namespace
}  // namespace carom

// Starts and speeds that are short binary numbers: balls without width. Exact coincidences are then
// exact zeros, and mean what they mean everywhere else.
#include <gtest/gtest.h>

#include "carom/events/world.hpp"
#include "certify/systems.hpp"
#include "certify/tie_names.hpp"
#include "random_tables.hpp"

namespace carom {
namespace {

using tests::exactly;
using tests::Shaped;
using tests::task_of;

struct Ray {
  std::string x, y, u, v;
};

ExactSystem along(Shaped s, const Ray& ray, const char* speed) {
  s.inside = {exactly(ray.x), exactly(ray.y)};
  ExactSystem system = tests::system_of(s, {exactly(ray.u), exactly(ray.v)});
  system.speed = exactly(speed);
  return system;
}
CertifiedEnd end_of(const ExactSystem& system, std::uint64_t collisions) {
  CertifiedOrbit orbit(system, task_of(collisions, 20));
  return orbit.finish();
}

Shaped rectangle() {
  return tests::shaped("rectangle", {{"width", "1"}, {"height", "1"}}, "0", "0");
}
Shaped stadium() {
  return tests::shaped("stadium", {{"half_length", "1"}, {"radius", "1"}}, "0", "0");
}
Shaped diamond() {
  Shaped s = tests::shaped("polygon", {}, "0", "0");
  s.spec.points["points"] = {{exactly("1"), exactly("0")},
                             {exactly("0"), exactly("1")},
                             {exactly("-1"), exactly("0")},
                             {exactly("0"), exactly("-1")}};
  return s;
}
Shaped sinai(bool torus) {
  Shaped s = tests::shaped("sinai", {{"side", "1"}, {"radius", "1/4"}}, "0", "0");
  s.spec.torus = torus;
  return s;
}

// The same ray from a point of it that no binary number names has the same ties, hits the same
// walls and ends there.
void expect_same_from_beside(const Shaped& s, const Ray& ray, std::size_t ties) {
  for (const char* speed : {"1", "5"}) {
    SCOPED_TRACE(s.spec.shape + " from " + ray.x + ", " + ray.y + " along " + ray.u + ", " + ray.v +
                 " with speed " + speed);
    const CertifiedEnd exact = end_of(along(s, ray, speed), 12);
    const Ray beside{ray.x + "+(" + ray.u + ")/100", ray.y + "+(" + ray.v + ")/100", ray.u, ray.v};
    const CertifiedEnd other = end_of(along(s, beside, speed), 12);
    EXPECT_EQ(name_of(exact.fate), name_of(other.fate));
    EXPECT_EQ(exact.reason, other.reason);
    EXPECT_EQ(exact.ties, other.ties);
    EXPECT_EQ(exact.ties.size(), ties);
    EXPECT_EQ(exact.collisions, other.collisions);
    EXPECT_EQ(exact.wall, other.wall);
    if (exact.collisions == 0) continue;
    EXPECT_EQ(exact.x.text(20), other.x.text(20));
    EXPECT_EQ(exact.y.text(20), other.y.text(20));
    EXPECT_EQ(exact.vx.text(20), other.vx.text(20));
    EXPECT_EQ(exact.vy.text(20), other.vy.text(20));
  }
}

TEST(ExactStarts, FlightsIntoCornersAgreeWithTheEngine) {
  expect_same_from_beside(rectangle(), {"5/8", "1/2", "3", "4"}, 2);
  expect_same_from_beside(rectangle(), {"1/2", "1/2", "1", "1"}, 6);
  expect_same_from_beside(rectangle(), {"1/2", "1/2", "-1", "1"}, 6);
  expect_same_from_beside(rectangle(), {"1/2", "1/4", "2", "3"}, 3);
  for (const auto& [u, v] : {std::pair{"1", "0"}, {"0", "1"}, {"-1", "0"}, {"0", "-1"}})
    expect_same_from_beside(diamond(), {"0", "0", u, v}, 6);
  // A reflex corner has no limit.
  const Shaped mushroom = tests::shaped(
      "mushroom", {{"cap_radius", "1"}, {"stem_width", "1"}, {"stem_height", "1"}}, "0", "0");
  expect_same_from_beside(mushroom, {"1/4", "1/2", "1", "-2"}, 0);
}

TEST(ExactStarts, FlightsIntoJointsAgreeWithTheEngine) {
  expect_same_from_beside(stadium(), {"1", "1/4", "0", "1"}, 12);
  expect_same_from_beside(stadium(), {"1", "-1/4", "0", "1"}, 12);
  expect_same_from_beside(stadium(), {"-1", "1/4", "0", "1"}, 12);
  expect_same_from_beside(stadium(), {"-1", "-1/4", "0", "-1"}, 12);
  expect_same_from_beside(stadium(), {"0", "0", "1", "1"}, 8);
}

TEST(ExactStarts, FlightsThatTouchDiscsAgreeWithTheEngine) {
  expect_same_from_beside(sinai(false), {"1/8", "1/4", "1", "0"}, 12);
  expect_same_from_beside(sinai(false), {"3/4", "7/8", "0", "-1"}, 12);
}

TEST(ExactStarts, FlightsAlongTheEdgeOfACorridorAgreeWithTheEngine) {
  const CertifiedEnd corridor = end_of(along(sinai(true), {"1/8", "1/4", "1", "0"}, "1"), 10);
  EXPECT_EQ(corridor.fate, CertifiedFate::singular);
  EXPECT_EQ(tests::named_in(corridor.reason), "1 disc");
}

Shaped bent() {  // an L: a reflex corner, and sides in line with others
  Shaped s = tests::shaped("polygon", {}, "0", "0");
  for (const auto& [x, y] :
       {std::pair{"-1", "-1"}, {"1", "-1"}, {"1", "0"}, {"0", "0"}, {"0", "1"}, {"-1", "1"}})
    s.spec.points["points"].push_back({exactly(x), exactly(y)});
  return s;
}

// From points of a grid along short vectors: many run into corners and joints, touch, or move along
// walls.
TEST(ExactStarts, StartsOnAGridAgreeWithTheEngine) {
  tests::Dice dice(11);
  const std::vector<Shaped> tables{
      rectangle(),
      stadium(),
      diamond(),
      bent(),
      sinai(false),
      tests::shaped("mushroom", {{"cap_radius", "1"}, {"stem_width", "1"}, {"stem_height", "1"}},
                    "0", "0"),
      tests::shaped("circle", {{"radius", "1"}}, "0", "0"),
      tests::shaped("annulus", {{"outer", "1"}, {"inner", "1/4"}, {"offset", "1/4"}}, "0", "0"),
      tests::shaped("lemon", {{"radius", "5/4"}, {"separation", "3/2"}}, "0", "0")};
  const std::vector<std::pair<const char*, const char*>> directions{
      {"1", "0"},  {"0", "1"},  {"-1", "0"}, {"0", "-1"}, {"1", "1"},
      {"-1", "1"}, {"1", "-1"}, {"3", "4"},  {"-4", "3"}, {"2", "-1"}};
  long ties = 0;
  for (long k = 0; k < tests::cases(400, 10000); ++k) {
    const Shaped& s = tables[static_cast<std::size_t>(k) % tables.size()];
    const Table table = build_table(s.spec);
    const World world(table);
    geometry::Vector P, u;
    Ray ray;
    do {
      const auto& d = directions[static_cast<std::size_t>(dice.between(0.0, 9.999))];
      const std::string x = std::to_string(static_cast<int>(dice.between(-8.5, 8.5))) + "/8",
                        y = std::to_string(static_cast<int>(dice.between(-8.5, 8.5))) + "/8";
      ray = {x, y, d.first, d.second};
      P = {exactly(x).to_double(), exactly(y).to_double()};
      u = {exactly(d.first).to_double(), exactly(d.second).to_double()};
    } while (!world.contains(P) || !world.contains(P + 0.01 * u) || !world.contains(P - 0.01 * u));
    const std::size_t before = end_of(along(s, ray, "5"), 12).ties.size();
    expect_same_from_beside(s, ray, before);
    ties += before > 0 ? 1 : 0;
    if (HasFailure()) return;
  }
  EXPECT_GT(ties, 20);
}

}  // namespace
}  // namespace carom

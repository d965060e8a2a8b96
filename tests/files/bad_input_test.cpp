// Faults of a system file: where they are, and what is near. tests/cli/messages.txt has more of
// them, and their messages.
#include "system_text.hpp"

namespace carom::tests {
namespace {

TEST(BadInput, AFaultHasItsLineColumnAndKey) {
  const InputError unknown = fault("[table]\nshape = \"rectangle\"\nwidht = 1\nheight = 1\n");
  EXPECT_EQ(unknown.place().file, "test.toml");
  EXPECT_EQ(unknown.place().line, 3);
  EXPECT_EQ(unknown.place().column, 1);
  EXPECT_EQ(unknown.place().key, "table.widht");
  EXPECT_EQ(unknown.nearest(), "width");
  EXPECT_NE(unknown.expected().find("height"), std::string::npos);
  const InputError value = fault(square("[run]\nt_max = 10\ntimes = [1, 3, 2]\n"));
  EXPECT_EQ(value.place().line, 7);
  EXPECT_EQ(value.place().column, 16);
  EXPECT_EQ(value.place().key, "run.times[2]");
}

TEST(BadInput, ObstaclesNameTheirKeyAndPlace) {
  const auto error = [](const std::string& keys) {
    return fault(square("[[table.obstacle]]\n" + keys));
  };
  EXPECT_EQ(error("shape = \"cirle\"\n").nearest(), "circle");
  EXPECT_EQ(error("shape = \"circle\"\ncentre = [0.5, 0.5]\nradius = 0.1\n").nearest(), "center");
  EXPECT_EQ(error("shape = \"circle\"\ncenter = [0.5, 0.5]\n").place().key,
            "table.obstacle[0].radius");
  EXPECT_EQ(error("shape = \"ellipse\"\ncenter = [0.5, 0.5]\na = 0.1\nb = -1\n").place().key,
            "table.obstacle[0].b");
  EXPECT_EQ(error("shape = \"ellipse\"\ncenter = [0.5, 0.5]\na = 0.1\nb = 0.1\nradius = 1\n")
                .place()
                .line,
            10);
  const InputError crossing = error("shape = \"circle\"\ncenter = [1, 0.5]\nradius = 0.1\n");
  EXPECT_EQ(crossing.place().line, 5);
  EXPECT_EQ(crossing.place().key, "table.obstacle[0]");
  EXPECT_FALSE(crossing.expected().empty());
}

TEST(BadInput, TooManyTimesAreRefused) {
  std::string list;
  for (int k = 0; k <= 100000; ++k) list += std::to_string(k) + ",";
  EXPECT_EQ(fault(square("[run]\nt_max = 1e6\ntimes = [" + list + "]\n")).place().key, "run.times");
}

TEST(BadInput, AFormulaHasTheColumnOfTheCharacter) {
  const std::string force =
      "[integrator]\nstep = 0.1\n[initial]\nkind = \"point\"\nposition = [0.5, 0.5]\nangle = 0\n";
  const auto expression = [&](const std::string& text) {
    return fault(square("[[potential]]\nkind = \"expression\"\nexpression = \"" + text +
                        "\"\nparameters = {depth = 2}\n" + force));
  };
  EXPECT_EQ(expression("depth*x^2").problem(), "no fault");
  // The quotation mark counts.
  EXPECT_EQ(expression("dpeth*x^2").place().column, 15);
  EXPECT_EQ(expression("dpeth*x^2").nearest(), "depth");
  EXPECT_EQ(expression("x^2 + sen(y)").place().column, 21);
  EXPECT_EQ(expression("x^2 + sen(y)").nearest(), "sin");
}

TEST(BadInput, PairsOnALatticeMustNotReachASecondCopy) {
  const std::string pairs =
      "[lattice]\nvectors = [[1, 0], [0.5, 0.8]]\n[particles]\ncount = 2\nspeed = 1\n[integrator]\n"
      "step = 0.01\n[interaction]\nkind = \"yukawa\"\nstrength = 1\nrange = ";
  EXPECT_EQ(fault(pairs + "0.01\n").problem(), "no fault");
  EXPECT_EQ(fault(pairs + "0.02\n").place().key, "interaction");
}

TEST(BadInput, ANegativeEnergyNeedsAPotential) {
  const std::string well =
      "[[potential]]\nkind = \"gaussian\"\nheight = -2\nwidth = 1\n[integrator]\nstep = 0.1\n";
  const std::string negative = "[particles]\nenergy = -1\n";
  EXPECT_EQ(fault(square(well + negative)).problem(), "no fault");
  EXPECT_EQ(fault(square(negative)).place().key, "particles.energy");
}

}  // namespace
}  // namespace carom::tests

// Second derivatives: the slopes of the forces, and the same law typed as a formula.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "carom/files/system_file.hpp"
#include "carom/forces/force_field.hpp"
#include "carom/forces/hessian.hpp"
#include "forces/formulas.hpp"

namespace carom {
namespace {

using geometry::Vector;

LoadedSystem system_with(const std::string& forces) { return read_system(forces, "test.toml"); }

Hessian external_hessian(const ForceField& f, const Particle& p, Vector x) {
  Hessian h;
  f.add_external_hessian(p, x, h);
  return h;
}

// A fourth-order difference of the force: its error is about h^4 and 1e-16/h, 1e-12 of the force's
// size on its own length.
Hessian by_differences(const std::function<Vector(Vector)>& force, Vector x, double h) {
  const auto slope = [&](Vector e) {
    const Vector near = force(x + h * e) - force(x - h * e);
    const Vector far = force(x + 2.0 * h * e) - force(x - 2.0 * h * e);
    return (1.0 / (12.0 * h)) * (8.0 * near - far);
  };
  const Vector along_x = slope({1.0, 0.0}), along_y = slope({0.0, 1.0});
  return {-along_x.x, -0.5 * (along_x.y + along_y.x), -along_y.y};
}

void expect_near(const Hessian& a, const Hessian& b, double tolerance, const std::string& where) {
  const double size = 1.0 + std::fabs(b.xx) + std::fabs(b.xy) + std::fabs(b.yy);
  EXPECT_NEAR(a.xx, b.xx, tolerance * size) << where;
  EXPECT_NEAR(a.xy, b.xy, tolerance * size) << where;
  EXPECT_NEAR(a.yy, b.yy, tolerance * size) << where;
}

struct Kind {
  const char* keys;     // of a [[potential]]
  const char* formula;  // the same, about (0.2, -0.1)
};

constexpr const char* squared = "((x-0.2)^2+(y+0.1)^2)";

std::string with_distance(std::string formula) {
  for (std::size_t at; (at = formula.find("R2")) != std::string::npos;)
    formula.replace(at, 2, squared);
  return formula;
}

const Kind kinds[] = {
    {"kind = \"harmonic\"\nomega_x = 0.8\nomega_y = 1.4",
     "0.5*1.75*(0.64*(x-0.2)^2+1.96*(y+0.1)^2)"},
    {"kind = \"quartic\"\nstrength = 0.9", "0.9*R2^2"},
    {"kind = \"power\"\nstrength = 0.9\nexponent = 3", "0.9*R2^1.5"},
    {"kind = \"power\"\nstrength = 0.9\nexponent = 2.3", "0.9*R2^1.15"},
    {"kind = \"power\"\nstrength = 0.9\nexponent = 6", "0.9*R2^3"},
    {"kind = \"coulomb\"\ncharge = 2.5", "1.5*2.5/sqrt(R2)"},
    {"kind = \"henon-heiles\"", "R2/2 + (x-0.2)^2*(y+0.1) - (y+0.1)^3/3"},
    {"kind = \"linear\"\nforce = [0.3, -1.2]", "-0.3*x+1.2*y"},
    {"kind = \"fermi\"\nheight = 1.3\nradius = 0.4\nsoftness = 0.3",
     "1.3/(1+exp((sqrt(R2)-0.4)/0.3))"},
    {"kind = \"gaussian\"\nheight = 1.3\nwidth = 0.6", "1.3*exp(-R2/(2*0.36))"},
    {"kind = \"soft-circle\"\nheight = 1.3\nradius = 1.1\nsoftness = 0.2",
     "1.3/(1+exp((1.1-sqrt(R2))/0.2))"},
};

constexpr const char* particle =
    "[particles]\nmass = 1.75\ncharge = 1.5\nenergy = 1000\n[integrator]\nstep = "
    "1e-3\n[initial]\nkind = \"point\"\n"
    "position = [0.5, 0.5]\nangle = 0\n";

TEST(Hessians, EveryPotentialHasThatOfItsFormula) {
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> uniform(-1.5, 1.5);
  for (const Kind& kind : kinds) {
    const LoadedSystem built =
        system_with(std::string(particle) + "[[potential]]\ncenter = [0.2, -0.1]\n" + kind.keys);
    const LoadedSystem typed = system_with(std::string(particle) +
                                           "[[potential]]\nkind = \"expression\"\nexpression = \"" +
                                           with_distance(kind.formula) + "\"");
    const Particle& p = built.system.particles[0];
    for (int i = 0; i < 40; ++i) {
      const Vector x{uniform(generator), uniform(generator)};
      expect_near(external_hessian(*built.system.dynamics.forces, p, x),
                  external_hessian(*typed.system.dynamics.forces, p, x), 1e-13, kind.keys);
    }
  }
}

TEST(Hessians, AreTheSlopesOfTheForces) {
  const char* const functions[] = {
      "sin(x*y)+cos(x)*tan(0.3*y)", "sinh(x)-cosh(y)*tanh(x+y)",      "exp(x)*log(2+y^2)^-2",
      "atan2(y+3,x^2+1)",           "abs(x-7)^1.5*max(y,-9*x-99)",    "(3+x)^(2+y)/(4-x*y)",
      "x^5-2*x^-3+(y+4)^2.5/7",     "min(x*y^2, 50+x)*sqrt(x^2+y^2)", "(5+x)^-1.5*(6+y)^0.7"};
  std::mt19937_64 generator(4);
  std::uniform_real_distribution<double> uniform(0.3, 1.2);
  for (const char* text : functions) {
    const TypedExpression f = formula(text);
    for (int i = 0; i < 20; ++i) {
      const Vector x{uniform(generator), uniform(generator)};
      const double at[] = {x.x, x.y};
      double gradient[2], hessian[4], first[2];
      const double value = f.value_gradient_and_hessian(at, gradient, hessian);
      EXPECT_EQ(value, f.value_and_gradient(at, first)) << text;
      EXPECT_EQ(gradient[0], first[0]) << text;
      EXPECT_EQ(gradient[1], first[1]) << text;
      const auto force = [&](Vector at_x) {
        const ValueAndGradient g = gradient_at(f, at_x.x, at_x.y);
        return Vector{-g.x, -g.y};
      };
      expect_near({hessian[0], hessian[1], hessian[3]}, by_differences(force, x, 1e-3), 1e-7, text);
      EXPECT_NEAR(hessian[1], hessian[2], 1e-12 * (1.0 + std::fabs(hessian[1]))) << text;
    }
  }
}

// On a lattice, in a soft stadium, and of pairs: no formula stands beside them.
TEST(Hessians, OfLatticesAndStadiumsAreSlopesToo) {
  const char* const systems[] = {
      "[lattice]\nvectors = [[1, 0], [\"1/2\", \"sqrt(3)/2\"]]\n[[potential]]\nkind = \"fermi\"\n"
      "lattice = true\nradius = 0.15\nsoftness = 0.1\n",
      "[lattice]\nvectors = [[1, 0], [0, 1]]\n[[potential]]\nkind = \"gaussian\"\nlattice = true\n"
      "width = 0.2\nheight = 0.7\n",
      "[[potential]]\nkind = \"soft-stadium\"\nhalf_length = 0.4\nradius = 0.3\nsoftness = 0.2\n"};
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> uniform(-0.4, 0.4);
  for (const char* text : systems) {
    const LoadedSystem loaded =
        system_with(std::string("[particles]\nenergy = 5\n[initial]\nkind = \"point\"\n"
                                "position = [0.25, 0.25]\nangle = 0\n") +
                    text);
    const ForceField& field = *loaded.system.dynamics.forces;
    const Particle& p = loaded.system.particles[0];
    for (int i = 0; i < 20; ++i) {
      Vector x{uniform(generator), uniform(generator)};
      if (dot(x, x) < 0.02) continue;  // a Fermi bump has a kink at its centre
      const auto force = [&](Vector at) {
        Vector f{};
        field.add_external(p, at, f);
        return f;
      };
      expect_near(external_hessian(field, p, x), by_differences(force, x, 1e-3), 1e-6, text);
    }
  }
}

TEST(Hessians, OfPairsAreSlopesToo) {
  const char* const interactions[] = {
      "kind = \"coulomb\"\nstrength = 1.3",
      "kind = \"yukawa\"\nstrength = 1.3\nrange = 0.4",
      "kind = \"lennard-jones\"\ndepth = 0.7\ndiameter = 0.9",
      "kind = \"soft-sphere\"\nstrength = 1.3\ndiameter = 0.9\nexponent = 9",
      "kind = \"soft-sphere\"\nstrength = 1.3\ndiameter = 0.9\nexponent = 12",
      "kind = \"expression\"\nexpression = \"exp(-r^2)/r\""};
  for (const char* text : interactions) {
    const LoadedSystem loaded = system_with(
        std::string("[particles]\ncount = 2\ncharge = [2, 0.75]\nenergy = 5\n[initial]\nkind = "
                    "\"rectangle\"\nmin = [-2, -2]\nmax = [2, 2]\n[interaction]\n") +
        text);
    const ForceField& field = *loaded.system.dynamics.forces;
    const auto& p = loaded.system.particles;
    for (const Vector d : {Vector{0.9, 0.4}, Vector{-1.1, 1.3}, Vector{0.3, -1.2}}) {
      const auto force = [&](Vector at) {
        Vector f{};
        field.add_pair(p[0], p[1], at, f);
        return f;
      };
      Hessian h;
      field.add_pair_hessian(p[0], p[1], d, h);
      expect_near(h, by_differences(force, d, 1e-3), 1e-6, text);
    }
  }
}

// Third powers of a distance have second derivatives at their centre, zero ones.
TEST(Hessians, PowersHaveOnesAtTheirCentre) {
  for (const char* text : {"(x^2+y^2)^1.5", "(x^2+y^2)^2.5", "(x^2+y^2)^1.7", "(x^2+y^2)^3"}) {
    const double at[] = {0.0, 0.0};
    double gradient[2], hessian[4];
    formula(text).value_gradient_and_hessian(at, gradient, hessian);
    for (const double second : hessian) EXPECT_EQ(second, 0.0) << text;
  }
}

}  // namespace
}  // namespace carom

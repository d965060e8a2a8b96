#include "system.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "forces.hpp"

namespace resolution {
namespace {

/// Numbers of one system: splitmix64 (Steele, Lea & Flood 2014), the same on every machine.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t index)
      : state_(seed * 0x9e3779b97f4a7c15u + 0x1234567u) {
    state_ = word() ^ (index * 0xd1342543de82ef95u);
    word();
  }
  std::uint64_t word() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double uniform(double from = 0.0, double to = 1.0) {
    return rounded(from + (to - from) * static_cast<double>(word() >> 11) * 0x1p-53);
  }
  double log_uniform(double from, double to) {
    return rounded(from *
                   std::exp(std::log(to / from) * static_cast<double>(word() >> 11) * 0x1p-53));
  }
  bool chance(double p) { return static_cast<double>(word() >> 11) * 0x1p-53 < p; }
  int below(int n) { return static_cast<int>(word() % static_cast<std::uint64_t>(n)); }

 private:
  // To 24 bits: the C library's last bit, which differs between machines, is not seen.
  static double rounded(double x) { return static_cast<double>(static_cast<float>(x)); }
  std::uint64_t state_;
};

constexpr double kinetic = 0.5;  // of every start, to rounding

double some_height(Random& random) {
  const double height = random.log_uniform(0.1 * kinetic, 1000 * kinetic);
  // Wells, too, but none so deep that all time is spent in it.
  return random.chance(0.12) ? -std::min(height, 50 * kinetic) : height;
}

struct Region {
  double left, right, bottom, top;
};

Term some_bump(Random& random, const Region& region) {
  Term t;
  t.shape = random.chance(0.2) ? Term::Shape::rational : Term::Shape::gaussian;
  t.height = some_height(random);
  t.width = random.log_uniform(0.002, 0.5);
  t.a = random.uniform(region.left, region.right);
  t.b = random.uniform(region.bottom, region.top);
  return t;
}

/// A direction (a, b) of length about 1: along x, along y, or oblique.
void choose_direction(Random& random, Term& t) {
  const int kind = random.below(4);
  const double angle = random.uniform(0.0, 2 * std::numbers::pi);
  const double sign = random.chance(0.5) ? 1.0 : -1.0;
  t.a = kind == 0   ? sign
        : kind == 1 ? 0.0
                    : static_cast<double>(static_cast<float>(std::cos(angle)));
  t.b = kind == 0   ? 0.0
        : kind == 1 ? sign
                    : static_cast<double>(static_cast<float>(std::sin(angle)));
}

Term some_ridge(Random& random, const Region& region) {
  Term t;
  const int kind = random.below(4);
  t.shape = kind < 2 ? Term::Shape::ridge : kind == 2 ? Term::Shape::soft_wall : Term::Shape::edge;
  t.height = t.shape == Term::Shape::soft_wall ? kinetic : some_height(random);
  t.width = random.log_uniform(0.002, 0.5);
  choose_direction(random, t);
  t.c = t.a * random.uniform(region.left, region.right) +
        t.b * random.uniform(region.bottom, region.top);
  return t;
}

void add_waves(Random& random, System& system) {
  const double length = random.log_uniform(0.01, 0.5);  // 1/k
  const double height = random.log_uniform(0.1 * kinetic, 100 * kinetic);
  const int kind = random.below(3);
  if (kind == 2) {
    Term t{Term::Shape::peaks, height};
    t.a = 1.0 / length;
    t.b = t.a * random.uniform(0.5, 1.0);
    t.c = random.log_uniform(1.0, 100.0);
    t.width = 1.0 / (t.a * std::sqrt(t.c));
    system.terms.push_back(t);
    return;
  }
  const int waves = 2 + kind;
  const double turn = random.chance(0.5) ? 0.0 : random.uniform(0.0, std::numbers::pi);
  for (int i = 0; i < waves; ++i) {
    Term t{Term::Shape::wave, height};
    const double angle = turn + i * std::numbers::pi / waves;
    t.width = length;
    t.a = static_cast<double>(static_cast<float>(std::cos(angle) / length));
    t.b = static_cast<double>(static_cast<float>(std::sin(angle) / length));
    t.c = random.uniform(0.0, 6.0);
    system.terms.push_back(t);
  }
}

void add_lattice(Random& random, System& system) {
  system.lattice = true;
  const int kind = random.below(3);
  system.vectors = {1.0, 0.0, 0.0, 1.0};
  if (kind > 0) system.vectors = {1.0, 0.0, 0.5, 0.8660254037844386};
  if (kind == 2) system.vectors[2] = random.uniform(-0.4, 0.4);
  Term t;
  t.height = random.log_uniform(0.1 * kinetic, 1000 * kinetic);
  if (random.chance(0.5)) {
    t.shape = Term::Shape::bells;
    t.width = random.log_uniform(0.002, 0.12);
  } else {
    t.shape = Term::Shape::fermi;
    t.width = random.log_uniform(0.002, 0.03);
    t.c = random.uniform(0.05, 0.35);
  }
  system.terms.push_back(t);
}

/// Without the linear part, whose zero is anywhere.
double potential(System system, double x, double y) {
  std::erase_if(system.terms, [](const Term& t) { return t.shape == Term::Shape::linear; });
  long double sum = 0;
  for (const auto& force : forces_of<long double>(system)) sum += force->potential(x, y);
  return static_cast<double>(sum);
}

/// A start of speed 1 where little of the energy is potential; half of them aim at a summand. False
/// if none is found.
bool choose_start(Random& random, System& system, const Region& region) {
  const bool aimed = random.chance(0.6);
  std::vector<Term> targets;
  for (const Term& t : system.terms)
    if (t.shape != Term::Shape::linear && t.shape != Term::Shape::wave &&
        t.shape != Term::Shape::peaks)
      targets.push_back(t);
  for (int attempt = 0; attempt < 200; ++attempt) {
    const double x = random.uniform(region.left, region.right),
                 y = random.uniform(region.bottom, region.top);
    double angle = random.uniform(0.0, 2 * std::numbers::pi);
    if (aimed && !targets.empty()) {
      const Term& t =
          targets[static_cast<std::size_t>(random.below(static_cast<int>(targets.size())))];
      double to_x = t.a - x, to_y = t.b - y;
      if (system.lattice) {
        to_x = -x + random.below(3) * system.vectors[0] + random.below(3) * system.vectors[2];
        to_y = -y + random.below(3) * system.vectors[1] + random.below(3) * system.vectors[3];
      }
      const bool line = t.shape == Term::Shape::ridge || t.shape == Term::Shape::soft_wall ||
                        t.shape == Term::Shape::edge;
      if (line) {
        const double s = t.a * x + t.b * y - t.c;
        to_x = -s * t.a;
        to_y = -s * t.b;
      }
      const double distance = std::hypot(to_x, to_y);
      if (distance < 3 * t.width) continue;
      const double miss =
          line ? random.uniform(-0.7, 0.7) : random.uniform(-2.0, 2.0) * t.width / distance;
      angle = std::atan2(to_y, to_x) + miss;
    }
    if (potential(system, x, y) > 0.5 * kinetic) continue;
    const auto to_single = [](double v) { return static_cast<double>(static_cast<float>(v)); };
    system.start = {x, y, to_single(std::cos(angle)), to_single(std::sin(angle))};
    return true;
  }
  return false;
}

bool try_system(Random& random, std::uint64_t index, System& system) {
  system = System();
  system.box = random.chance(0.5);
  Region region = {-1.0, 1.0, -1.0, 1.0};
  if (system.box) {
    system.width = random.uniform(1.0, 3.0);
    system.height = random.uniform(1.0, 3.0);
    region = {0.05, system.width - 0.05, 0.05, system.height - 0.05};
  }
  if (random.chance(0.2)) system.field = random.uniform(-3.0, 3.0);
  switch (index % 6) {
    case 0:
      system.family = "bump";
      system.terms.push_back(some_bump(random, region));
      break;
    case 1:
      system.family = "bumps";
      for (int i = 2 + random.below(5); i-- > 0;) system.terms.push_back(some_bump(random, region));
      break;
    case 2:
      system.family = "ridge";
      for (int i = 1 + random.below(2); i-- > 0;)
        system.terms.push_back(some_ridge(random, region));
      break;
    case 3:
      system.family = "waves";
      add_waves(random, system);
      break;
    case 4:
      system.family = "lattice";
      system.box = false;
      region = {0.02, 0.98, 0.02, 0.98};
      add_lattice(random, system);
      break;
    default:
      system.family = "frame";
      system.field = (random.chance(0.5) ? 1 : -1) * random.log_uniform(0.3, 10.0);
      for (int i = 1 + random.below(3); i-- > 0;) system.terms.push_back(some_bump(random, region));
      Term pull{Term::Shape::linear};
      const double drift = random.log_uniform(0.2, 5.0),
                   angle = random.uniform(0.0, 2 * std::numbers::pi);
      pull.a = static_cast<double>(static_cast<float>(std::cos(angle) * drift * system.field));
      pull.b = static_cast<double>(static_cast<float>(std::sin(angle) * drift * system.field));
      system.terms.push_back(pull);
      break;
  }
  system.scale = 1e30;
  for (const Term& t : system.terms)
    if (t.width > 0.0) system.scale = std::min(system.scale, t.width);
  system.longest_time = random.uniform(2.0, 6.0);
  return choose_start(random, system, region);
}

std::string written(double value) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, value);
  return std::string(text, end.ptr);
}

/// For a place in a formula: negative numbers in parentheses.
std::string in_formula(double value) {
  return value < 0.0 ? "(" + written(value) + ")" : written(value);
}

std::string distance(const std::string& coordinate, double from) {
  return from == 0.0 ? coordinate : "(" + coordinate + "-" + in_formula(from) + ")";
}

std::string formula(const Term& t) {
  const std::string height = in_formula(t.height), width = in_formula(t.width);
  const std::string square = "(" + distance("x", t.a) + "^2+" + distance("y", t.b) + "^2)";
  const std::string s =
      "(" + in_formula(t.a) + "*x+" + in_formula(t.b) + "*y-" + in_formula(t.c) + ")";
  switch (t.shape) {
    case Term::Shape::gaussian:
      return height + "*exp(-" + square + "/(2*" + width + "^2))";
    case Term::Shape::rational:
      return height + "/(1+" + square + "/" + width + "^2)";
    case Term::Shape::ridge:
      return height + "*exp(-" + s + "^2/(2*" + width + "^2))";
    case Term::Shape::soft_wall:
      return height + "*exp(-" + s + "/" + width + ")";
    case Term::Shape::edge:
      return height + "*(1-tanh(" + s + "/" + width + "))/2";
    case Term::Shape::wave:
      return height + "*cos" + s;
    case Term::Shape::peaks:
      return height + "*exp(" + in_formula(t.c) + "*(cos(" + in_formula(t.a) + "*x)+cos(" +
             in_formula(t.b) + "*y)-2))";
    case Term::Shape::linear:
      return "(-(" + in_formula(t.a) + "*x+" + in_formula(t.b) + "*y))";
    default:
      return {};
  }
}

}  // namespace

System random_system(std::uint64_t seed, std::uint64_t index) {
  Random random(seed, index);
  System system;
  while (!try_system(random, index, system)) {
  }
  return system;
}

std::string toml(const System& system, double t_max, const std::string& integrator) {
  std::string text;
  if (system.box)
    text += "[table]\nshape = \"rectangle\"\nwidth = " + written(system.width) +
            "\nheight = " + written(system.height) + "\n";
  if (system.lattice)
    text += "[lattice]\nvectors = [[" + written(system.vectors[0]) + ", " +
            written(system.vectors[1]) + "], [" + written(system.vectors[2]) + ", " +
            written(system.vectors[3]) + "]]\n";
  std::string sum;
  for (const Term& t : system.terms) {
    if (t.shape == Term::Shape::fermi) {
      text += "[[potential]]\nkind = \"fermi\"\nheight = " + written(t.height) +
              "\nradius = " + written(t.c) + "\nsoftness = " + written(t.width) +
              "\nlattice = true\n";
    } else if (t.shape == Term::Shape::bells) {
      text += "[[potential]]\nkind = \"gaussian\"\nheight = " + written(t.height) +
              "\nwidth = " + written(t.width) + "\nlattice = true\n";
    } else {
      sum += (sum.empty() ? "" : "+") + formula(t);
    }
  }
  if (!sum.empty()) text += "[[potential]]\nkind = \"expression\"\nexpression = \"" + sum + "\"\n";
  if (system.field != 0.0) text += "[field]\nB = " + written(system.field) + "\n";
  text += "[initial]\nkind = \"point\"\nposition = [" + written(system.start[0]) + ", " +
          written(system.start[1]) + "]\nvelocity = [" + written(system.start[2]) + ", " +
          written(system.start[3]) + "]\n";
  text += "[integrator]\n" + integrator + "[run]\nt_max = " + written(t_max) + "\n";
  return text;
}

}  // namespace resolution

// Every fault of a system file: its message names place, key, what was expected and what is near.
#include "system_text.hpp"

namespace carom::tests {
namespace {

struct Fault {
  const char* text;
  const char* message;
};

void expect(const std::vector<Fault>& faults) {
  for (const Fault& f : faults) EXPECT_HAS(fault(f.text), f.message) << "\nof\n" << f.text;
}

void expect_in_square(const std::vector<Fault>& faults) {
  for (const Fault& f : faults) EXPECT_HAS(fault(square(f.text)), f.message) << "\nof\n" << f.text;
}

TEST(BadInput, UnknownNamesShowPlaceAndNearest) {
  EXPECT_EQ(fault("[table]\nshape = \"rectangle\"\nwidht = 1\nheight = 1\n"),
            "test.toml, line 3, column 1: table.widht: unknown key 'widht' for 'rectangle' "
            "(expected one of "
            "shape, width, height, obstacle, hole; did you mean 'width'?)");
  expect(
      {{"[table]\nshape = \"rectangel\"\n",
        "line 2, column 9: table.shape: unknown shape 'rectangel'"},
       {"[table]\nshape = \"rectangel\"\n", "did you mean 'rectangle'?"},
       {"[tabel]\nshape = \"circle\"\n", "line 1, column 2: tabel: unknown section or key 'tabel'"},
       {"[tabel]\nshape = \"circle\"\n", "did you mean 'table'?"},
       {"[table]\nshape = \"circle\"\nradius = 1\nwidth = 2\n", "it belongs to rectangle"},
       {"titel = \"x\"\n", "did you mean 'title'?"}});
  expect_in_square(
      {{"[[table.hole]]\nwal = \"top\"\n", "table.hole[0].wal: unknown key 'wal'"},
       {"[field]\nb = 1\n", "did you mean 'B'?"},
       {"[run]\ntmax = 1\n", "did you mean 't_max'?"},
       {"[run]\ntimes = {from = 1, to = 2, cuont = 3}\n", "did you mean 'count'?"},
       {"[initial]\nkind = \"unifrom\"\n", "did you mean 'uniform'?"},
       {"[initial]\nkind = \"point\"\nwall = \"top\"\n", "it belongs to boundary, birkhoff"},
       {"[initial]\nkind = \"boundary\"\nwall = \"topp\"\n", "did you mean 'top'?"},
       {"[particles]\nsped = 1\n", "did you mean 'speed'?"}});
}

InputError error_of(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    return error;
  }
  return InputError("no fault");
}

TEST(BadInput, ObstaclesNameTheirKeyAndPlace) {
  const auto error = [](const std::string& keys) {
    return error_of(square("[[table.obstacle]]\n" + keys));
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

TEST(BadInput, MissingThingsAreNamed) {
  expect({{"", "table: the section [table] is missing"},
          {"[table]\nwidth = 1\n", "table.shape: the key 'shape' is missing"},
          {"[table]\nshape = \"circle\"\n",
           "line 2, column 9: table.radius: the shape 'circle' needs 'radius'"}});
  expect_in_square(
      {{"[[table.hole]]\nwall = \"top\"\nwidth = 1\n",
        "table.hole[0].center: the key 'center' is missing"},
       {"[initial]\nkind = \"hole\"\n", "initial.hole: the key 'hole' is missing"},
       {"[initial]\nkind = \"point\"\nposition = [0.5, 0.5]\n", "neither velocity nor angle"},
       {"[initial]\nkind = \"birkhoff\"\nwall = \"top\"\n", "initial.s: the key 's' is missing"}});
}

TEST(BadInput, WrongTypesAreNamed) {
  expect(
      {{"table = 3\n", "table: must be a section [table], not a number"},
       {"title = 3\n"
        "[table]\nshape = \"circle\"\nradius = 1\n",
        "title: must be a string in quotes, not a number"},
       {"[table]\nshape = 3\n", "table.shape: must be a string in quotes, not a number"},
       {"[table]\nshape = \"circle\"\nradius = true\n",
        "line 3, column 10: table.radius: must be a number"},
       {"[table]\nshape = \"circle\"\nradius = [1]\n", "not a list"},
       {"[table]\nshape = \"circle\"\nradius = 1979-05-27\n", "not a date or time"},
       {"[table]\nshape = \"sinai\"\nside = 1\nradius = 0.1\ntorus = 1\n",
        "table.torus: must be true or false"},
       {"[table]\nshape = \"polygon\"\npoints = [[0, 0], [1]]\n",
        "table.points[1]: a point has two coordinates"},
       {"[table]\nshape = \"polygon\"\npoints = [[0, 0], 1]\n", "table.points[1]: must be a point"},
       {"[table]\nshape = \"circle\"\nradius = 1\nhole = 3\n", "table.hole: must be a list"}});
  expect_in_square(
      {{"[run]\nseed = \"x\"\n", "run.seed: must be a whole number of at least 0, not x"},
       {"[run]\ntimes = true\n", "run.times: must be a list of times or a table"},
       {"[[run]]\n", "run: must be a section [run], not a list"}});
}

TEST(BadInput, NumbersMustBeNumbersAndInRange) {
  expect(
      {{"[table]\nshape = \"circle\"\nradius = 0\n",
        "line 3, column 10: table.radius: must be positive, not 0"},
       {"[table]\nshape = \"circle\"\nradius = -1.5\n", "table.radius: must be positive, not -1.5"},
       {"[table]\nshape = \"circle\"\nradius = nan\n", "table.radius: "},
       {"[table]\nshape = \"circle\"\nradius = nan\n", "'nan' is not a finite number"},
       {"[table]\nshape = \"circle\"\nradius = -inf\n", "'inf' is not a finite number"},
       {"[table]\nshape = \"circle\"\nradius = \"1/0\"\n", "table.radius: "},
       {"[table]\nshape = \"circle\"\nradius = \"sqrt(-1)\"\n", "table.radius: "},
       {"[table]\nshape = \"circle\"\nradius = \"1e999\"\n", "table.radius: "},
       {"[table]\nshape = \"circle\"\nradius = \"wide\"\n", "table.radius: unknown word 'wide'"}});
}

TEST(BadInput, TheFieldIsRefusedWhereItMeansNothing) {
  expect_in_square(
      {{"[field]\nB = 1\nlarmor_radius = 1\n",
        "line 7, column 17: field.larmor_radius: 'B' and 'larmor_radius' are both given"},
       {"[field]\nlarmor_radius = 0\n", "field.larmor_radius: must be positive, not 0"},
       {"[field]\nlarmor_radius = -1\n", "must be positive"},
       {"[field]\nB = inf\n", "not a finite number"},
       {"[field]\nlarmor_radius = 1\n[particles]\nspeed = [1, 2]\n",
        "field.larmor_radius: the particles differ"},
       {"[field]\nlarmor_radius = 1\n[particles]\nmass = [1, 2]\n", "the particles differ"},
       {"[field]\nlarmor_radius = 1\n[particles]\ncharge = [1, -1]\n", "the particles differ"},
       {"[field]\nlarmor_radius = 1\n[particles]\ncharge = 0\n",
        "a neutral particle has no Larmor radius"}});
}

TEST(BadInput, ParticlesMustMoveAndBeCounted) {
  expect_in_square(
      {{"[particles]\nspeed = 0\n", "line 6, column 9: particles.speed: must be positive, not 0"},
       {"[particles]\nspeed = -1\n", "must be positive, not -1"},
       {"[particles]\nenergy = 0\n", "particles.energy: must be positive"},
       {"[particles]\nspeed = 1\nenergy = 1\n", "'speed' and 'energy' are both given"},
       {"[particles]\nmass = 0\n", "particles.mass: must be positive"},
       {"[particles]\nmass = [1, -2]\n", "particles.mass[1]: must be positive, not -2"},
       {"[particles]\nmass = []\n", "particles.mass: the list is empty"},
       {"[particles]\ncount = 0\n",
        "particles.count: must be a whole number from 1 to 1000000, not 0"},
       {"[particles]\ncount = 1.5\n", "not 1.5"},
       {"[particles]\ncount = 3\nspeed = [1, 2]\n", "particles.speed: 2 values for 3 particles"},
       {"[particles]\nmass = [1, 2]\nspeed = [1, 2, 3]\n", "3 values for 2 particles"}});
}

TEST(BadInput, StartsMustBePossible) {
  expect_in_square(
      {{"[initial]\nkind = \"sobol\"\n",
        "line 6, column 8: initial.kind: the kind 'sobol' is not in this version"},
       {"[initial]\nkind = \"file\"\npath = \"x\"\n", "'x' cannot be read: No such file"},
       {"[initial]\nkind = \"hole\"\nhole = \"door\"\n",
        "initial.hole: unknown hole 'door' (expected a table with [[table.hole]])"},
       {"[[table.hole]]\nwall=\"top\"\ncenter=0.5\nwidth=0.1\nname=\"door\"\n[initial]\nkind = "
        "\"hole\"\nhole = \"dor\"\n",
        "did you mean 'door'?"},
       {"[initial]\nkind = \"boundary\"\nwall = \"top\"\nhole = \"a\"\n", "both given"},
       {"[initial]\nkind = \"point\"\nposition = [0.5, 0.5]\nvelocity = [0, 0]\n",
        "the velocity is zero"},
       {"[particles]\nspeed = 1\n[initial]\nkind = \"point\"\nposition = [0.5, 0.5]\nvelocity = "
        "[0, 0]\n",
        "the velocity is zero"},
       {"[initial]\nkind = \"point\"\nposition = [0.5, 0.5]\nvelocity = [0, 1]\nangle = 1\n",
        "both given"},
       {"[initial]\nkind = \"rectangle\"\nmin = [0.5, 0.5]\nmax = [0.4, 0.6]\n",
        "initial.max: max lies below min"},
       {"[initial]\nkind = \"birkhoff\"\nwall = \"top\"\ns = 1\nv_parallel = 0\n",
        "initial.s: the wall has no arc length 1"},
       {"[initial]\nkind = \"birkhoff\"\nwall = \"top\"\ns = 0.5\nv_parallel = -1\n",
        "initial.v_parallel: v_parallel -1 leaves nothing"},
       {"[initial]\nkind = \"birkhoff\"\nwall = \"top\"\ns = [0.5, 0.6]\nv_parallel = [0, 0.1, "
        "0.2]\n",
        "differ in length"},
       {"[initial]\nkind = \"birkhoff\"\nwall = \"top\"\ns = {from = 0, to = 1}\nv_parallel = 0\n",
        "initial.s.count: the key 'count' is missing"}});
  expect({{"[table]\nshape = \"discs\"\ncenters = [[0, 0]]\nradius = 1\n",
           "initial.kind: the open plane has no uniform"}});
}

TEST(BadInput, RunsMustEndAndHaveTrajectories) {
  expect_in_square(
      {{"[run]\nt_max = 0\n", "line 6, column 9: run.t_max: must be positive, not 0"},
       {"[run]\nt_max = -1\n", "run.t_max: must be positive, not -1"},
       {"[run]\nt_max = inf\n", "not a finite number"},
       {"[run]\nt_max = \"long\"\n", "run.t_max: unknown word 'long'"},
       {"[run]\ntrajectories = 0\n", "run.trajectories: must be a whole number from 1 to "},
       {"[run]\ntrajectories = -5\n", ", not -5"},
       {"[run]\ntrajectories = \"many\"\n", ", not many"},
       {"[run]\ntrajectories = 1.5\n", ", not 1.5"},
       {"[run]\nseed = -1\n", "run.seed: must be a whole number of at least 0, not -1"},
       {"[run]\nseed = 18446744073709551616\n", "not valid TOML"},
       {"[run]\nseed = \"18446744073709551616\"\n",
        "run.seed: must be a whole number below 2^64, not 18446744073709551616"},
       {"[run]\ncollisions = 0\n", "run.collisions: must be a whole number of at least 1"},
       {"[run]\nsample = 0\n", "run.sample: must be positive"}});
}

TEST(BadInput, TimesMustIncreaseUpToTheEnd) {
  expect_in_square(
      {{"[run]\ntimes = []\n", "run.times: the list is empty"},
       {"[run]\ntimes = [1, 3, 2]\n", "run.times[2]: the times do not increase at 2"},
       {"[run]\ntimes = [-1]\n", "run.times[0]: must not be negative"},
       {"[run]\nt_max = 10\ntimes = [1, 11]\n", "run.times: the time 11 comes after t_max = 10"},
       {"[run]\ntimes = {from = 0, to = 10}\n", "run.times.from: must be positive"},
       {"[run]\ntimes = {from = 2, to = 1}\n", "run.times.to: the times end before they begin"},
       {"[run]\ntimes = {from = 1, to = 2, count = 1}\n",
        "run.times.count: must be a whole number from 2"},
       {"[run]\ntimes = {from = 1, to = 2, count = 100001}\n",
        "run.times.count: must be a whole number from 2 to 100000"},
       {"[run]\ntimes = {from = 1, to = 2, spacing = \"logg\"}\n", "did you mean 'log'?"}});
  std::string list;
  for (int k = 0; k <= 100000; ++k) list += std::to_string(k) + ",";
  EXPECT_HAS(fault(square("[run]\nt_max = 1e6\ntimes = [" + list + "]\n")), "at most 100000 times");
}

TEST(BadInput, HolesAreCheckedWithTheirPlace) {
  expect_in_square(
      {{"[[table.hole]]\nwall = \"botom\"\ncenter = 0.5\nwidth = 0.1\n",
        "line 6, column 8: table.hole[0].wall: unknown wall 'botom'"},
       {"[[table.hole]]\nwall = \"top\"\ncenter = 0.5\nwidth = 1.5\n",
        "line 8, column 9: table.hole[0].width: the hole is wider than its wall"},
       {"[[table.hole]]\nwall = \"top\"\ncenter = 0.5\nwidth = 0.5\n[[table.hole]]\nwall = "
        "\"top\"\n"
        "center = 0.6\nwidth = 0.5\n",
        "line 11, column 10: table.hole[1].center: the hole 'hole_2' overlaps 'hole_1'"}});
}

TEST(BadInput, PathsAreCheckedWithTheirPlace) {
  const std::string head = "[table]\nshape = \"path\"\n[[table.loop]]\nstart = [0, 0]\n";
  EXPECT_HAS(fault(head + "pieces = [{line_to = [1, 0]}, {line_to = [0, 1]}]\n"),
             "line 5, column 31: table.loop[0].pieces[1]: the path is open");
  EXPECT_HAS(fault(head + "pieces = [{line_to = [1, 0], arc_to = [0, 1]}]\n"),
             "either a line or an arc or an ellipse");
  EXPECT_HAS(fault(head + "pieces = [{lin_to = [1, 0]}]\n"), "did you mean 'line_to'?");
  EXPECT_HAS(fault(head + "pieces = [{arc_to = [1, 0]}]\n"),
             "table.loop[0].pieces[0].arc_via: the key 'arc_via' is missing");
  EXPECT_HAS(fault(head), "table.loop[0].pieces: the key 'pieces' is missing");
}

TEST(BadInput, Forces) {
  EXPECT_HAS(fault(square("[[potential]]\nkind = \"ferni\"\n")), "did you mean 'fermi'?");
  EXPECT_HAS(fault(square("[[potential]]\nkind = \"fermi\"\nradius = 0.1\n")), "softness");
  EXPECT_HAS(fault(square("[[potential]]\nkind = \"gaussian\"\nwidth = -1\n")), "must be positive");
  EXPECT_HAS(
      fault(square("[[potential]]\nkind = \"coulomb\"\ncharge = -1\n[integrator]\nstep = 0.1\n")),
      "attracts");
  EXPECT_HAS(fault(square("[[potential]]\nkind = \"gaussian\"\nwidth = 1\nlattice = true\n")),
             "there is none");
  EXPECT_HAS(fault(square("[potential]\nkind = \"harmonic\"\n")),
             "[[potential]], with two brackets");
  EXPECT_HAS(fault(square("[interaction]\nkind = \"coulom\"\n")), "did you mean 'coulomb'?");
  EXPECT_HAS(fault(square("[interaction]\nkind = \"hard-discs\"\nradii = [1, 2]\n")),
             "2 radii for 1 particles");
}

TEST(BadInput, ForcesThatHaveNoMeaning) {
  const std::string formula = "[[potential]]\nkind = \"expression\"\n",
                    step = "[integrator]\nstep = 0.1\n";
  const std::string point = "[initial]\nkind = \"point\"\nposition = [0.5, 0.5]\nangle = 0\n";
  const auto expression = [&](const std::string& text) {
    return fault(square(formula + "expression = \"" + text + "\"\nparameters = {depth = 2}\n" +
                        step + point));
  };
  EXPECT_EQ(expression("depth*x^2"), "no fault");
  // The column is that of the character within the line, quotation mark and all.
  EXPECT_HAS(expression("dpeth*x^2"),
             "test.toml, line 7, column 15: potential[0].expression: unknown name 'dpeth'");
  EXPECT_HAS(expression("dpeth*x^2"), "did you mean 'depth'?");
  EXPECT_HAS(expression("x^2 + sen(y)"), "line 7, column 21");
  EXPECT_HAS(expression("x^2 + sen(y)"), "did you mean 'sin'?");
  EXPECT_HAS(expression("x + 1/0"),
             "line 7, column 20: potential[0].expression: this is not finite");
  EXPECT_HAS(expression("(x + 1"), "line 7");
  const std::string sums =
      "[lattice]\nvectors = [[1, 0], [0, 1]]\n[[potential]]\nkind = \"fermi\"\nradius = 0.1\n";
  EXPECT_HAS(fault(sums + "softness = 1000\nlattice = true\n" + step + point), "as good as flat");
  EXPECT_HAS(fault(sums + "softness = 0.1\n" + step + point), "every potential has to be repeated");
  EXPECT_HAS(fault("[interaction]\nkind = \"coulomb\"\n[particles]\ncharge = [1, -1]\n" + step),
             "attract each other");
}

TEST(BadInput, PairsOnALatticeFeelTheirNearestCopiesAlone) {
  const std::string pairs =
      "[lattice]\nvectors = [[1, 0], [0.5, 0.8]]\n[particles]\ncount = 2\nspeed = 1\n[integrator]\n"
      "step = 0.01\n[interaction]\nkind = \"yukawa\"\nstrength = 1\nrange = ";
  EXPECT_EQ(fault(pairs + "0.01\n"), "no fault");
  EXPECT_HAS(
      fault(pairs + "0.02\n"),
      "further than half the lattice's shortest period, 0.4717");  // |(1, 0) - (0.5, 0.8)| / 2
}

TEST(BadInput, EnergiesAreTotalOnlyWhereForcesAct) {
  const std::string well =
      "[[potential]]\nkind = \"gaussian\"\nheight = -2\nwidth = 1\n[integrator]\nstep = 0.1\n";
  const std::string negative = "[particles]\nenergy = -1\n";
  EXPECT_EQ(fault(square(well + negative)), "no fault");
  EXPECT_HAS(fault(square(negative)), "must be positive");
  EXPECT_HAS(fault(square("[interaction]\nkind = \"coulomb\"\n" + negative)), "must be positive");
  EXPECT_HAS(fault(square("[interaction]\nkind = \"hard-discs\"\nradius = 0.1\n" + negative +
                          "count = 2\n")),
             "must be positive");
  EXPECT_HAS(fault(square(well + negative + "[field]\nlarmor_radius = 1\n")), "no Larmor radius");
}

TEST(BadInput, Integrator) {
  EXPECT_HAS(fault(square("[integrator]\nscheme = \"forest-ruth\"\n")),
             "did you mean 'forest-ruth-4'?");
  EXPECT_HAS(fault(square("[integrator]\nscheme = \"forest-ruth\"\n")), "velocity-verlet");
  EXPECT_HAS(fault(square("[integrator]\nstep = 0\n")), "must be positive");
  EXPECT_HAS(fault(square("[integrator]\nstep = -1\n")), "must be positive");
}

TEST(BadInput, FilesAndNames) {
  const auto fault_of = [](const std::string& name) {
    try {
      load_system(name);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no fault");
  };
  EXPECT_HAS(fault_of("no-such-file.toml"),
             "no-such-file.toml: cannot be read: No such file or directory");
  EXPECT_HAS(fault_of("./"), "is a folder");
  EXPECT_HAS(fault_of("stadum"), "unknown system 'stadum'");
  EXPECT_HAS(fault_of("stadum"), "did you mean 'stadium'?");
}

}  // namespace
}  // namespace carom::tests

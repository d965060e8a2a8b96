// The tables of datasets in docs/guide/archive.md are those that the fields of results make. After
// a change of fields: CAROM_WRITE_PAGES=1 test_files --gtest_filter=FieldTables.*
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "analyses/compare/columns.hpp"
#include "analyses/diffusion/describe.hpp"
#include "analyses/escape/describe.hpp"
#include "analyses/lyapunov/describe.hpp"
#include "analyses/returns/describe.hpp"
#include "carom/analyses/compare.hpp"
#include "carom/analyses/kinds.hpp"
#include "carom/analyses/relax.hpp"
#include "carom/analyses/run.hpp"
#include "carom/analyses/run/rows.hpp"
#include "carom/analyses/section.hpp"
#include "carom/files/system_file.hpp"
#include "carom/orbits/periodic_orbit.hpp"
#include "files/describe/reference.hpp"

namespace carom::files {
namespace {

const std::string path = CAROM_SOURCE "/docs/guide/archive.md";
const std::string begins = "<!-- fields: ", ends = "<!-- end of fields -->\n";

template <class List>
std::string columns() {
  FieldTable table;
  table.add_fields<List>();
  return table.text("column");
}
template <class Result>
std::string described(const Result& result) {
  Reference reference;
  analyses::describe(reference, result, load_system("stadium").system);
  return reference.text();
}

std::map<std::string, std::string> tables() {
  DiffusionResult diffusion;
  diffusion.free_paths = FreePathSums(1.0);
  LyapunovResult lyapunov;
  lyapunov.spectrum = SpectrumSums(GrowthSums({1.0, 2.0}, 64), 4, 2);
  lyapunov.repeller.emplace();
  return {{"collisions", columns<Fields<HitRow>>()},
          {"trajectory", columns<Fields<SampleRow>>()},
          {"contacts", columns<Fields<ContactRow>>()},
          {"energy", columns<Fields<EnergyRow>>()},
          {"state", columns<Fields<ParticleProgress>>()},
          {"section", columns<Fields<SectionPoint>>()},
          {"records", columns<ExponentFields>()},
          {"equilibria", columns<Fields<Equilibrium>>()},
          {"orbits", columns<Fields<PeriodicOrbit>>()},
          {"orbit hits", columns<Fields<OrbitHit>>()},
          {"comparison", columns<Fields<Comparison>>()},
          {"schemes", columns<Fields<analyses::StoredSchemeRow>>()},
          {"runs", columns<Fields<analyses::StoredRunRow>>()},
          {"escape", described(EscapeResult())},
          {"diffusion", described(diffusion)},
          {"lyapunov", described(lyapunov)},
          {"returns", described(ReturnsResult())}};
}

TEST(FieldTables, AreThoseOfTheGuide) {
  std::stringstream page;
  page << std::ifstream(path).rdbuf();
  std::string text = page.str(), made;
  std::size_t at = 0, found = 0;
  const std::map<std::string, std::string> all = tables();
  for (std::size_t begin; (begin = text.find(begins, at)) != text.npos; ++found) {
    const std::size_t name = begin + begins.size(), line = text.find(" -->\n", name);
    const std::size_t end = text.find(ends, line);
    ASSERT_NE(end, text.npos);
    const auto table = all.find(text.substr(name, line - name));
    ASSERT_NE(table, all.end()) << text.substr(name, line - name);
    made += text.substr(at, line + 5 - at) + table->second;
    at = end;
  }
  made += text.substr(at);
  EXPECT_EQ(found, all.size()) << "each of them once";
  if (std::getenv("CAROM_WRITE_PAGES"))
    std::ofstream(path) << made;
  else
    EXPECT_EQ(text, made) << "CAROM_WRITE_PAGES=1 writes the page";
}

}  // namespace
}  // namespace carom::files

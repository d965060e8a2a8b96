// The tables of datasets in docs/guide/archive.md, and of keys of JSON in docs/guide/commands/,
// are those that the fields of results make. After a change of fields: CAROM_WRITE_PAGES=1
// test_files --gtest_filter=FieldTables.*
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
#include "files/reference.hpp"

namespace carom::files {
namespace {

const std::string begins = "<!-- fields: ", ends = "<!-- end of fields -->\n";

template <class List>
std::string columns() {
  FieldTable table;
  table.add_fields<List>();
  return table.text("column");
}
template <class Result>
std::string described(const Result& result, Kept kept) {
  Reference reference(kept);
  analyses::describe(reference, result, load_system("stadium").system);
  return reference.text();
}

using Tables = std::map<std::string, std::string>;

// Of each kind of ensemble, with all that it may hold.
Tables ensembles(Kept kept) {
  DiffusionResult diffusion;
  diffusion.free_paths = FreePathSums(1.0);
  LyapunovResult lyapunov;
  lyapunov.spectrum = SpectrumSums(GrowthSums({1.0, 2.0}, 64), 4, 2);
  lyapunov.repeller.emplace();
  return {{"escape", described(EscapeResult(), kept)},
          {"diffusion", described(diffusion, kept)},
          {"lyapunov", described(lyapunov, kept)},
          {"returns", described(ReturnsResult(), kept)}};
}

Tables datasets() {
  Tables all = ensembles(Kept::datasets);
  all.merge(Tables{{"collisions", columns<Fields<HitRow>>()},
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
                   {"runs", columns<Fields<analyses::StoredRunRow>>()}});
  return all;
}

Tables keys() {
  FieldTable section(Kept::keys);
  section.add_fields<Fields<SectionResult>>();
  section.add_fates();
  section.add_fields<Fields<EnergyError>>();
  Tables all = ensembles(Kept::keys);
  all.emplace("section", section.text("key"));
  return all;
}

void expect_tables(const std::string& name_of_page, const Tables& all) {
  const std::string path = CAROM_SOURCE "/docs/guide/" + name_of_page;
  std::stringstream page;
  page << std::ifstream(path).rdbuf();
  std::string text = page.str(), made;
  std::size_t at = 0, found = 0;
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

TEST(FieldTables, OfDatasetsAreThoseOfTheGuide) { expect_tables("archive.md", datasets()); }
TEST(FieldTables, OfKeysAreThoseOfTheGuide) {
  for (const auto& [command, table] : keys())
    expect_tables("commands/" + command + ".md", {{command, table}});
}

}  // namespace
}  // namespace carom::files

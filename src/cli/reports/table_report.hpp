// What a table is, for machines and for people.
#pragma once

#include <string>

#include "carom/ensemble/stopwatch.hpp"
#include "carom/ensemble/system.hpp"
#include "io/json.hpp"

namespace carom::cli {

/// `output`: the drawing, or "".
Json table_json(const System&, const TableMeasure&, const std::string& output, const Stopwatch&);
/// `verbose`: with all of many walls.
std::string table_text(const System&, const TableMeasure&, const std::string& output,
                       bool verbose = false);

}  // namespace carom::cli

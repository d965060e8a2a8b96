// What a table is, for machines and for people.
#pragma once

#include <string>

#include "carom/files/system_file.hpp"
#include "carom/system/system.hpp"
#include "files/json.hpp"

namespace carom::cli {

/// `output`: the drawing, or "". Holes have the numbers that were written.
files::Json table_json(const LoadedSystem&, const TableMeasure&, const std::string& output,
                       double seconds, double cpu_seconds);
/// `verbose`: with all of many walls.
std::string table_text(const System&, const TableMeasure&, const std::string& output,
                       bool verbose = false);

}  // namespace carom::cli

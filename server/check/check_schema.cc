#include "check/check_schema.h"

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "database/migrate.h"

namespace affskel::server {
namespace {

struct Part {
  std::string kind;
  std::string name;
  friend auto operator<=>(const Part&, const Part&) = default;
};

/// All parts, sorted.
std::vector<Part> parts_of(Database& db) {
  Statement row = db.query(
      "SELECT type, name FROM sqlite_schema UNION"
      " SELECT 'column', s.name || '.' || c.name FROM sqlite_schema s, pragma_table_info(s.name) c"
      " WHERE s.type = 'table' ORDER BY 1, 2");
  std::vector<Part> parts;
  while (row.step()) parts.push_back({row.text(0), row.text(1)});
  return parts;
}

}  // namespace

bool check_schema(Database& db, int schema, FaultLog& faults) {
  Database model(":memory:", Database::Mode::kReadWrite);
  for (const Migration& step : embedded_migrations()) {
    if (step.number <= std::abs(schema)) model.execute(step.sql);
  }
  const std::vector<Part> found = parts_of(db), known = parts_of(model);
  bool readable = true;
  for (const Part& part : found) {
    // A trigger that is not ours changes what is stored, a table may have one.
    if (std::binary_search(known.begin(), known.end(), part) || part.name.starts_with("sqlite_")) continue;
    if (part.kind != "column") faults.add(part.kind + " " + part.name, "is none of this program's");
  }
  for (const Part& part : known) {
    if (std::binary_search(found.begin(), found.end(), part)) continue;
    faults.add(part.kind + " " + part.name, "is missing");
    readable = readable && part.kind != "table" && part.kind != "column";
  }
  return readable;
}

}  // namespace affskel::server

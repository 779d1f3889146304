#include "client/operations/repair.h"

#include <utility>

#include "base/number_text.h"
#include "client/base/error.h"
#include "core/base/error.h"
#include "core/solid/solid.h"

namespace affskel::client {
namespace {

constexpr double kMaxFilled = 0.2;  // of the surface: beyond, what is computed is hardly what was scanned

core::RepairOptions options_for(const RepairChoice& choice, core::ExecutionContext* context) {
  core::RepairOptions options;
  options.kind = choice.kind == RepairChoice::Kind::kWrap ? core::RepairKind::kWrap : core::RepairKind::kMend;
  options.longest_hole = choice.longest_hole;
  options.alpha = choice.alpha;
  options.context = context;
  return options;
}

}  // namespace

Repair repair(const core::Mesh& mesh, const std::string& file, const RepairChoice& choice,
              core::ExecutionContext* context) {
  Repair done;
  try {
    if (choice.kind == RepairChoice::Kind::kNone) {
      core::SolidOptions options;
      options.repair = false;
      options.check_self_intersections = false;
      options.context = context;
      done.mesh = mesh;
      done.volume = core::make_solid(mesh, options).volume;
      return done;
    }
    core::RepairedMesh repaired = core::repair_mesh(mesh, options_for(choice, context));
    done.left = repaired.left;
    done.longest_left = repaired.longest_left;
    if (done.left.empty() && repaired.filled_share > kMaxFilled && choice.kind == RepairChoice::Kind::kAuto) {
      done.left = "what would fill its holes is " + base::rounded(100 * repaired.filled_share, 3) +
                  " % of the surface, too much to be done unasked";
      done.longest_left = repaired.longest_filled;
    }
    done.mesh = std::move(repaired.mesh);
    done.steps = std::move(repaired.steps);
    done.filled_share = repaired.filled_share;
    if (done.left.empty()) done.volume = repaired.volume;
  } catch (const core::CoreError& error) {
    throw error_from_core(error, file);
  }
  return done;
}

Notices repair_warnings(const std::vector<core::RepairStep>& steps, const std::string& file) {
  Notices warnings;
  for (const core::RepairStep& step : steps)
    if (is_warning(step)) warnings.push_back(warning(step.code, step.message, file));
  return warnings;
}

Notices solid_warnings(const core::Mesh& mesh, const std::string& file) {
  Notices warnings;
  for (const core::MeshNote& note : core::make_solid(mesh).notes) {
    if (note.severity != core::MeshNote::Severity::kWarning) continue;
    warnings.push_back(warning(note.code, note.message, file));
    if (note.code != "self-intersecting") continue;
    v1::Setting& wrap = warnings.back().to_try.emplace_back();
    wrap.set_name("repair");
    wrap.set_value("wrap");
  }
  return warnings;
}

MeshSource replace_mesh(InputFile& input, Repair repaired) {
  MeshSource source{std::string(OffText(input).view()), std::move(repaired.steps)};
  input.off = core::OffMesh();
  input.off.mesh = std::move(repaired.mesh);
  if (input.off_text) input.bytes = core::write_off(input.off.mesh);
  return source;
}

}  // namespace affskel::client

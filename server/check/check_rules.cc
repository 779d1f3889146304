#include "check/check_rules.h"

namespace affskel::server {
namespace {

// Each names where and what for every fault of its kind.

// Ownership: everything stored is needed by a job or marked for deletion.  See store_space.cc.
constexpr const char* kOwnership[] = {
    "SELECT 'erosion ' || e.id, 'is marked for deletion, but job ' || j.id || ' needs it'"
    " FROM erosions e JOIN jobs j ON j.erosion_id = e.id WHERE e.dropped = 1",

    "SELECT 'erosion ' || id, 'no job needs it, and it is not marked for deletion'"
    " FROM erosions WHERE dropped = 0 AND id NOT IN (SELECT erosion_id FROM jobs)",

    "SELECT 'mesh ' || d.sha256, 'is marked for deletion, but erosion ' || e.id || ' needs it'"
    " FROM dropped_meshes d JOIN erosions e ON e.mesh_sha256 = d.sha256",

    "SELECT 'mesh ' || d.sha256, 'is marked for deletion, but the repair of job ' || r.job_id || ' needs it'"
    " FROM dropped_meshes d JOIN repairs r ON r.source_sha256 = d.sha256",

    "SELECT 'mesh ' || sha256, 'nothing needs it, and it is not marked for deletion' FROM meshes"
    " WHERE sha256 NOT IN (SELECT mesh_sha256 FROM erosions)"
    " AND sha256 NOT IN (SELECT source_sha256 FROM repairs)"
    " AND sha256 NOT IN (SELECT sha256 FROM dropped_meshes)",

    "SELECT 'erosion ' || e.id, 'is not finished, but ' || count(*) || ' jobs share it'"
    " FROM erosions e JOIN jobs j ON j.erosion_id = e.id WHERE e.finished = 0 GROUP BY e.id"
    " HAVING count(*) > 1",
};

// What is done, and what must or must not be there by then: store_reports.cc, store_complete.cc.
constexpr const char* kProgress[] = {
    "SELECT 'erosion ' || id, directions_done || ' directions are counted as done, the ranges have ' || n"
    " FROM (SELECT id, directions_done, (SELECT ifnull(sum(end_position - first_position), 0)"
    " FROM done_ranges WHERE erosion_id = e.id) AS n FROM erosions e) WHERE n <> directions_done",

    "SELECT 'erosion ' || e.id, 'positions up to ' || max(r.end_position) || ' are done, of '"
    " || ifnull(e.directions, 0) FROM erosions e JOIN done_ranges r ON r.erosion_id = e.id"
    " GROUP BY e.id HAVING max(r.end_position) > ifnull(e.directions, 0)",

    "SELECT 'erosion ' || erosion_id, 'the done range that begins at ' || next || ' is not apart from the one"
    " that begins at ' || first_position FROM (SELECT *, lead(first_position) OVER"
    " (PARTITION BY erosion_id ORDER BY first_position) AS next FROM done_ranges) WHERE next <= end_position",

    "SELECT 'erosion ' || id, 'is not prepared, but has a field or artefacts' FROM erosions e"
    " WHERE core_version IS NULL AND dropped = 0 AND"
    " (EXISTS (SELECT 1 FROM field_chunks WHERE erosion_id = e.id)"
    " OR EXISTS (SELECT 1 FROM field_log WHERE erosion_id = e.id)"
    " OR EXISTS (SELECT 1 FROM artifacts WHERE erosion_id = e.id))",

    "SELECT 'erosion ' || id, 'is finished, but not all of its field is merged' FROM erosions e"
    " WHERE finished = 1 AND dropped = 0 AND (EXISTS (SELECT 1 FROM field_log WHERE erosion_id = e.id)"
    " OR EXISTS (SELECT 1 FROM refined_log WHERE erosion_id = e.id))",

    // The refinement: refinement.cc.
    "SELECT 'erosion ' || id, refined_points || ' points are counted as refined, the ranges have ' || n"
    " FROM (SELECT id, refined_points, (SELECT ifnull(sum(end_position - first_position), 0)"
    " FROM refined_ranges WHERE erosion_id = e.id) AS n FROM erosions e) WHERE n <> refined_points",

    "SELECT 'erosion ' || erosion_id, 'the refined range that begins at ' || next || ' is not apart from the"
    " one that begins at ' || first_position FROM (SELECT *, lead(first_position) OVER"
    " (PARTITION BY erosion_id ORDER BY first_position) AS next FROM refined_ranges) WHERE next <= end_position",

    "SELECT 'erosion ' || id, 'is finished, but its refinement is not' FROM erosions WHERE finished = 1"
    " AND refines AND dropped = 0 AND (round IS NULL OR refined_points <> points)",

    "SELECT 'erosion ' || id, 'is refined before all of its directions are done' FROM erosions"
    " WHERE round IS NOT NULL AND directions_done IS NOT directions",

    "SELECT 'erosion ' || e.id, 'has ' || e.mesh_bytes || ' bytes of mesh noted, the mesh has ' || m.bytes"
    " FROM erosions e JOIN meshes m ON m.sha256 = e.mesh_sha256 WHERE e.mesh_bytes <> m.bytes",

    "SELECT 'artefact ' || a.id, 'a ' || a.kind || ' of erosion ' || e.id || ', which is not finished'"
    " FROM artifacts a JOIN erosions e ON e.id = a.erosion_id"
    " WHERE a.kind NOT IN ('lattice', 'directions') AND e.finished = 0 AND e.dropped = 0",
};

// Of job j, see own_skeleton(): a sheet's surface, with the alpha that sheets have, or its points, as earlier versions
// stored it.
#define OWN_SKELETON \
  "VALUES ('skeleton', j.skeleton_key), ('surface', j.skeleton_key || ' alpha=0000000000000000')"

// Jobs against their erosions: settle_job().
constexpr const char* kJobs[] = {
    "SELECT 'job ' || j.id, 'is in stage ' || j.stage || ', its erosion is ' || CASE"
    " WHEN e.finished THEN 'finished' WHEN e.core_version IS NULL THEN 'not prepared'"
    " WHEN e.round IS NOT NULL THEN 'being refined'"
    " ELSE 'prepared and not finished' END FROM jobs j JOIN erosions e ON e.id = j.erosion_id"
    " WHERE j.removed_ms = 0 AND j.stage NOT IN (CASE WHEN e.finished THEN 'derive' WHEN e.core_version IS "
    "NULL THEN 'prepare' WHEN e.round IS NOT NULL THEN 'refine'"
    " ELSE 'erode' END, iif(e.finished, 'complete', ''))",

    "SELECT 'job ' || j.id, 'is done, but its skeleton is missing' FROM jobs j WHERE j.state = 'done'"
    " AND j.removed_ms = 0 AND NOT EXISTS (SELECT 1 FROM artifacts WHERE erosion_id = j.erosion_id"
    " AND (kind, params_key) IN (" OWN_SKELETON "))",

    "SELECT 'job ' || j.id, 'tells of ' || j.skeleton_points || ' skeleton points, its skeleton has '"
    " || a.items FROM jobs j JOIN artifacts a ON a.erosion_id = j.erosion_id"
    " AND (a.kind, a.params_key) IN (" OWN_SKELETON
    ") WHERE j.state = 'done' AND j.skeleton_points <> a.items"
    " AND NOT EXISTS (SELECT 1 FROM artifacts WHERE erosion_id = j.erosion_id"
    " AND (kind, params_key) IN (" OWN_SKELETON ") AND items = j.skeleton_points)",

    ("SELECT 'job ' || id, 'is ' || state || ', but still to be cancelled' FROM jobs"
     " WHERE cancel_requested = 1 AND state NOT IN ('queued', 'running')"),

    "SELECT 'job ' || j.id, 'is to be cancelled, and waits for no worker' FROM jobs j"
    " WHERE j.cancel_requested = 1 AND j.state IN ('queued', 'running') AND NOT EXISTS"
    " (SELECT 1 FROM tasks WHERE job_id = j.id AND state = 'leased' AND on_request = 0)",
};

// Tasks against jobs and what is done: a job without the task that it waits for would wait for ever.
constexpr const char* kTasks[] = {
    "SELECT 'job ' || j.id, 'is in stage prepare, but no task is left to prepare it' FROM jobs j"
    " WHERE j.stage = 'prepare' AND NOT EXISTS (SELECT 1 FROM tasks"
    " WHERE job_id = j.id AND kind = 'prepare' AND state IN ('pending', 'leased'))",

    "SELECT 'job ' || j.id, 'is in stage derive, but no task is left to make its skeleton' FROM jobs j"
    " WHERE j.stage = 'derive' AND NOT EXISTS (SELECT 1 FROM tasks WHERE job_id = j.id"
    " AND (kind, params_key) IN (" OWN_SKELETON ") AND on_request = 0 AND state IN ('pending', 'leased'))",

    "SELECT 'job ' || j.id, 'its blocks do not cover positions 0 to ' ||"
    " coalesce(e.directions, '(none yet)') || ' once' FROM jobs j"
    " JOIN erosions e ON e.id = j.erosion_id LEFT JOIN"
    " (SELECT job_id, first_position, end_position, lead(first_position) OVER"
    "  (PARTITION BY job_id ORDER BY first_position) AS next FROM tasks WHERE kind = 'erode') t"
    " ON t.job_id = j.id WHERE j.stage = 'erode' GROUP BY j.id HAVING min(t.first_position) IS NOT 0"
    " OR max(t.end_position) IS NOT e.directions"
    " OR sum(t.next IS NOT NULL AND t.next <> t.end_position) > 0",

    "SELECT 'job ' || j.id, 'its blocks of round ' || e.round || ' do not cover points 0 to ' || e.points || ' once'"
    " FROM jobs j JOIN erosions e ON e.id = j.erosion_id LEFT JOIN"
    " (SELECT job_id, round, first_position, end_position, lead(first_position) OVER"
    "  (PARTITION BY job_id, round ORDER BY first_position) AS next FROM tasks WHERE kind = 'refine') t"
    " ON t.job_id = j.id AND t.round = e.round WHERE j.stage = 'refine' GROUP BY j.id"
    " HAVING min(t.first_position) IS NOT 0 OR max(t.end_position) IS NOT e.points"
    " OR sum(t.next IS NOT NULL AND t.next <> t.end_position) > 0",

    "SELECT 'task ' || t.id, 'block ' || t.first_position || ' to ' || t.end_position || ' of job ' || j.id"
    " || ' is done, but not all of its points are' FROM tasks t JOIN jobs j ON j.id = t.job_id"
    " JOIN erosions e ON e.id = j.erosion_id WHERE t.kind = 'refine' AND t.state = 'done'"
    " AND t.round = e.round AND NOT EXISTS (SELECT 1 FROM refined_ranges r"
    " WHERE r.erosion_id = j.erosion_id AND r.first_position <= t.first_position"
    " AND r.end_position >= t.end_position)",

    "SELECT 'task ' || t.id, 'is ' || t.state || ', of round ' || t.round || ', job ' || j.id || ' is in round '"
    " || ifnull(e.round, '(none)') FROM tasks t JOIN jobs j ON j.id = t.job_id JOIN erosions e ON e.id = j.erosion_id"
    " WHERE t.kind = 'refine' AND t.state <> 'done' AND t.round IS NOT e.round",

    "SELECT 'task ' || t.id, 'block ' || t.first_position || ' to ' || t.end_position || ' of job ' || j.id"
    " || ' is done, but not all of its positions are' FROM tasks t JOIN jobs j ON j.id = t.job_id"
    " WHERE t.kind = 'erode' AND t.state = 'done' AND NOT EXISTS (SELECT 1 FROM done_ranges r"
    " WHERE r.erosion_id = j.erosion_id AND r.first_position <= t.first_position"
    " AND r.end_position >= t.end_position)",

    "SELECT 'task ' || t.id, 'is ' || t.state || ', a task to ' || t.kind || ' job ' || j.id"
    " || ', which is in stage ' || j.stage FROM tasks t JOIN jobs j ON j.id = t.job_id"
    " WHERE t.state <> 'done' AND t.on_request = 0 AND (t.kind = 'prepare' AND j.stage <> 'prepare'"
    " OR t.kind = 'erode' AND j.stage <> 'erode' OR t.kind = 'refine' AND j.stage <> 'refine')",

    "SELECT 'task ' || t.id, 'a ' || t.kind || ' of job ' || j.id || ', whose field is not finished'"
    " FROM tasks t JOIN jobs j ON j.id = t.job_id JOIN erosions e ON e.id = j.erosion_id"
    " WHERE t.kind NOT IN ('prepare', 'erode', 'refine') AND e.finished = 0",

    // Of the job, copied, which triggers keep so.
    "SELECT 'task ' || t.id, 'its place in the queue is not that of its job ' || j.id FROM tasks t"
    " JOIN jobs j ON j.id = t.job_id JOIN erosions e ON e.id = j.erosion_id WHERE t.state = 'pending'"
    " AND (t.seq <> j.seq OR t.priority <> j.priority OR t.owner <> j.owner OR t.parked <> (t.kind = "
    "'verify' OR t.on_request = 0 AND"
    " (j.state NOT IN ('queued', 'running') OR j.cancel_requested = 1))"
    " OR t.needs_core <> iif(t.kind IN ('erode', 'refine'), ifnull(e.core_version, ''), t.needs_core))",

    ("SELECT 'task ' || id, 'has failed alone: it belongs to job ' || job_id || ', which fails with it'"
     " FROM tasks WHERE state = 'failed' AND on_request = 0"),
};

// The ready tasks by owner, which triggers keep.  A row too few, and the tasks wait for
// ever.
constexpr const char* kQueues[] = {
    "WITH counted AS (SELECT owner, on_request, needs_core, needs_memory, priority, count(*) AS ready"
    " FROM tasks"
    " WHERE state = 'pending' AND parked = 0 GROUP BY owner, on_request, needs_core, needs_memory, priority)"
    " SELECT 'queue of owner ' || quote(c.owner),"
    " 'counts ' || ifnull(q.ready, 0) || ' ready tasks of priority '"
    " || c.priority || ', there are ' || c.ready FROM counted c LEFT JOIN queues q USING (owner, on_request,"
    " needs_core, needs_memory, priority) WHERE q.ready IS NOT c.ready"
    " UNION ALL SELECT 'queue of owner ' || quote(q.owner),"
    " 'counts ' || q.ready || ' ready tasks of priority '"
    " || q.priority || ', there are none' FROM queues q LEFT JOIN counted c USING (owner, on_request,"
    " needs_core, needs_memory, priority) WHERE c.ready IS NULL",

    "SELECT 'queue of owner ' || quote(q.owner), 'does not have its owner''s turn' FROM queues q"
    " LEFT JOIN turns t USING (owner, on_request) WHERE q.turn IS NOT t.turn",
};

// What owners use, which triggers count.
constexpr const char* kUse[] = {
    "SELECT 'erosion ' || id, 'is counted with ' || bytes || ' bytes, it has ' || n"
    " FROM (SELECT e.id, e.bytes,"
    " iif(EXISTS (SELECT 1 FROM jobs WHERE erosion_id = e.id"
    " AND removed_ms > 0), 0, (20 + 52 * e.refines) * ifnull(e.points, 0))"
    " + (SELECT ifnull(sum(bytes), 0) FROM artifacts WHERE erosion_id = e.id) AS n FROM erosions e"
    " WHERE e.dropped = 0) WHERE n <> bytes",

    "SELECT 'use of owner ' || quote(owner), 'is counted as ' || counted || ', is ' || there"
    " FROM (SELECT u.owner,"
    " u.queued_jobs || ' jobs, ' || u.mesh_bytes || ' and ' || u.stored_bytes || ' bytes' AS counted,"
    " (SELECT count(*) FROM jobs WHERE owner = u.owner"
    " AND state IN ('queued', 'running')) || ' jobs, ' || m.bytes"
    " || ' and ' || (m.bytes + (SELECT ifnull(sum(bytes), 0) FROM erosions WHERE id IN"
    "  (SELECT erosion_id FROM jobs WHERE owner = u.owner))) || ' bytes' AS there"
    " FROM owner_use u JOIN (SELECT u.owner, (SELECT ifnull(sum(bytes), 0) FROM meshes WHERE sha256 IN"
    "  (SELECT e.mesh_sha256 FROM jobs j JOIN erosions e ON e.id = j.erosion_id"
    " WHERE j.owner = u.owner UNION SELECT source_sha256 FROM repairs WHERE owner = u.owner)) AS bytes"
    "  FROM owner_use u) m USING (owner)) WHERE counted <> there",
};

template <std::size_t count>
void check_all(Database& db, FaultLog& faults, const char* const (&rules)[count]) {
  for (const char* rule : rules) {
    Statement row = db.query(rule);
    while (row.step()) faults.add(row.text(0), row.text(1));
    faults.end_kind();
  }
}

}  // namespace

void check_rules(Database& db, FaultLog& faults) {
  check_all(db, faults, kOwnership);
  check_all(db, faults, kProgress);
  check_all(db, faults, kJobs);
  check_all(db, faults, kTasks);
  check_all(db, faults, kQueues);
  check_all(db, faults, kUse);
}

}  // namespace affskel::server

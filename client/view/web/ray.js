// Where a ray meets triangles: Moller and Trumbore 1997, in double precision.

/**
 * positions: 3 per vertex; corners: 3 per triangle, of which the first `count` numbers count; ray: origin and
 * unit direction `along`; skips(x, y, z): whether a place is not there.  Returns null, or of the first triangle
 * that is met its number, its three `vertices`, the `weights` of these, and
 * the `place`.
 * @param {ArrayLike<number>} positions
 * @param {ArrayLike<number>} corners
 * @param {number} count
 * @param {Ray} ray
 * @param {(x: number, y: number, z: number) => boolean} skips
 * @returns {Hit | null}
 */
export function firstHit(positions, corners, count, { origin, along }, skips) {
  let hit = null;
  for (let t = 0; t < count; t += 3) {
    const [a, b, c] = [3 * corners[t], 3 * corners[t + 1], 3 * corners[t + 2]];
    const [ax, ay, az] = [positions[a], positions[a + 1], positions[a + 2]];
    const [ux, uy, uz] = [positions[b] - ax, positions[b + 1] - ay, positions[b + 2] - az];
    const [vx, vy, vz] = [positions[c] - ax, positions[c + 1] - ay, positions[c + 2] - az];
    const [px, py, pz] = [along.y * vz - along.z * vy, along.z * vx - along.x * vz, along.x * vy - along.y * vx];
    const volume = ux * px + uy * py + uz * pz;
    if (volume === 0) continue;
    const [sx, sy, sz] = [origin.x - ax, origin.y - ay, origin.z - az];
    const wb = (sx * px + sy * py + sz * pz) / volume;
    if (wb < 0 || wb > 1) continue;
    const [qx, qy, qz] = [sy * uz - sz * uy, sz * ux - sx * uz, sx * uy - sy * ux];
    const wc = (along.x * qx + along.y * qy + along.z * qz) / volume;
    if (wc < 0 || wb + wc > 1) continue;
    const depth = (vx * qx + vy * qy + vz * qz) / volume;
    if (hit && depth >= hit.depth) continue;
    const place = [origin.x + depth * along.x, origin.y + depth * along.y, origin.z + depth * along.z];
    if (skips(place[0], place[1], place[2])) continue;
    hit = {
      depth,
      place,
      triangle: t / 3,
      vertices: [a / 3, b / 3, c / 3],
      weights: [1 - wb - wc, wb, wc],
    };
  }
  return hit;
}

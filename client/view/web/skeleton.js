// The two kinds of skeleton that a page can hold, behind one interface: sample points with their |H|, or a
// sheet in pieces with their shares of its weight.  Both are sorted by the value that the threshold slider
// compares, descending.  `at(ray)` gives what a ray meets first: null, or its place (page units), the values
// there and the directions.
import { Vector3 } from 'three';
import { BallCloud } from './clouds.js';
import { coloursOf } from './colours.js';
import { prefixLength } from './decode.js';
import { whole } from './numbers.js';
import { Sheet } from './sheet.js';

const kTube = 0.3; // radius of a curve, lattice spacings

// Unit vectors are kept as bytes: none or one.
const directions = (bytes, p) => {
  const v = new Vector3(...bytes.subarray(3 * p, 3 * p + 3));
  return v.lengthSq() > 0 ? [v.normalize().toArray()] : [];
};

/**
 * The mean of the values at a hit's vertices; null where there are none.
 * @param {ArrayLike<number> | undefined} values
 * @param {Hit} hit
 * @returns {number | null}
 */
export const weighted = (values, { vertices, weights }) =>
  values && values.length ? vertices.reduce((sum, v, i) => sum + weights[i] * values[v], 0) : null;

// What a vertex of `ridge` is: see TriangleMesh.kind of the contract.
const kKinds = ['ridge surface', 'ridge curve', 'membrane', 'way'];

/**
 * What a triangle or segment is part of: a membrane or way begins at the ridge's vertices.  '' where it is not known.
 * @param {ArrayLike<number> | undefined} kinds per vertex
 * @param {number[]} vertices
 * @returns {string}
 */
export const kindOf = (kinds, vertices) =>
  kinds && kinds.length ? kKinds[Math.max(...vertices.map((v) => kinds[v]))] : '';

/**
 * Like the operator's significance, the slider drops pieces with a smaller share.
 * @param {ModelFacts} model
 * @param {number} highest
 * @param {import('./clip.js').Clip} clip
 */
function makeSheet({ arrays, threshold, cell, operator }, highest, clip) {
  const { sheetPieceShares: shares, sheetPieces: pieceOf } = arrays;
  const colours = coloursOf(arrays.sheetShares, highest);
  const [a, b, c] = cell.map((step) => new Vector3(...step));
  const spacing = Math.cbrt(Math.abs(a.dot(b.cross(c))));
  const { sheetPositions, sheetCorners, sheetSegments } = arrays;
  const sheet = new Sheet(sheetPositions, colours, pieceOf, sheetCorners, sheetSegments, kTube * spacing, clip);
  const values = Float32Array.from(sheet.order, (t) => shares[pieceOf[t]]);
  return {
    drawn: sheet,
    places: sheetPositions,
    values,
    name: 'Sheet pieces',
    symbol: 'share ≥',
    curve: 3, // most are small
    low: 0,
    // Joining and placing may have split off pieces below the operator's threshold: then 0, the whole sheet.
    first: shares.every((share) => share >= threshold) ? threshold : 0,
    keeps: (value, least) => value >= least,
    choice: shares.length > 1, // of one piece there is nothing to drop
    describe(elements, least) {
      const triangles = sheet.count(elements, 'triangle');
      const segments = sheet.count(elements, 'segment');
      const spots = sheet.count(elements, 'spot');
      const curves = segments ? ` and ${whole(segments)} segments of curves` : '';
      const points = spots === 1 ? 'a point' : `${whole(spots)} points`;
      const what = elements === spots ? points : `${whole(triangles)} triangles${curves}`;
      const kept = prefixLength(shares, null, (share) => share >= least);
      const pieces = shares.length === 1 ? 'one piece' : `${whole(kept)} of ${whole(shares.length)} pieces`;
      return shares.length === 0 ? 'the sheet is empty' : `${what} in ${pieces}`;
    },
    at(ray) {
      const hit = sheet.pick(ray);
      if (!hit) return null;
      const nearest = hit.vertices[hit.weights.indexOf(Math.max(...hit.weights))];
      const sides = [arrays.sheetNormalsA, arrays.sheetNormalsB].filter(Boolean);
      const kind = kindOf(arrays.sheetKinds, hit.vertices);
      return {
        what: `skeleton (${operator})${kind && `: ${kind}`}`,
        place: hit.place,
        share: weighted(arrays.sheetShares, hit) || 0,
        slope: weighted(arrays.sheetSlopes, hit),
        strength: weighted(arrays.sheetStrengths, hit),
        directions: sides.flatMap((bytes) => directions(bytes, nearest)),
      };
    },
  };
}

/**
 * @param {ModelFacts} model
 * @param {number} highest
 * @param {import('./clip.js').Clip} clip
 * @param {Float32Array} positions
 */
function makeBalls({ arrays, cell, lowestThreshold, threshold, operator }, highest, clip, positions) {
  const colours = coloursOf(arrays.pointShares, highest);
  const values = arrays.pointDivergences; // descending, see page.cc
  const cloud = new BallCloud(positions, colours, cell, clip);
  return {
    drawn: cloud,
    places: positions,
    values,
    name: 'Shock threshold',
    symbol: '|H| >',
    curve: 1,
    low: Math.max(lowestThreshold, threshold / 10),
    first: threshold,
    keeps: (value, least) => value > least,
    choice: true,
    describe: (points) => `${whole(points)} skeleton points`,
    at(ray) {
      const p = cloud.pick(ray);
      if (p < 0) return null;
      return {
        what: `skeleton point (${operator})`,
        place: Array.from(positions.subarray(3 * p, 3 * p + 3)),
        share: arrays.pointShares[p],
        slope: arrays.pointSlopes[p],
        divergence: values[p],
        directions: directions(arrays.pointInward, p),
      };
    },
  };
}

/**
 * highest: E of the last colour, as a share of v0.  positions: of the sample points, page units.
 * @param {ModelFacts} model
 * @param {number} highest
 * @param {import("./clip.js").Clip} clip
 * @param {Float32Array} positions
 * @returns {Skeleton}
 */
export function makeSkeleton(model, highest, clip, positions) {
  const made = model.arrays.sheetCorners
    ? makeSheet(model, highest, clip)
    : makeBalls(model, highest, clip, positions);
  const { drawn, values, low, keeps } = made;
  return {
    ...made,
    high: values.length ? Math.max(values[0], low) : low,
    // Returns how many points, or triangles and segments, are shown.
    show(threshold) {
      const count = prefixLength(values, null, (value) => keeps(value, threshold));
      drawn.showFirst(count);
      return count;
    },
  };
}

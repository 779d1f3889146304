// The two kinds of skeleton that a page can hold, behind one interface: sample points with their |H|, or a
// sheet in pieces with their shares of its weight.  Both are sorted by the value that the threshold slider
// compares, descending.
import { Vector3 } from 'three';
import { BallCloud } from './clouds.js';
import { coloursOf } from './colours.js';
import { descending, prefixLength } from './decode.js';
import { whole } from './numbers.js';
import { Sheet } from './sheet.js';
import { sublattice } from './neighbours.js';

const kTube = 0.3; // radius of a curve, lattice spacings

// Like the operator's significance, the slider drops pieces with a smaller share.
function makeSheet({ arrays, highestShare, threshold, cell }) {
  const { sheetPieceShares: shares, sheetPieces: pieceOf } = arrays;
  const colours = coloursOf(arrays.sheetShares, highestShare);
  const [a, b, c] = cell.map((step) => new Vector3(...step));
  const spacing = Math.cbrt(Math.abs(a.dot(b.cross(c))));
  const { sheetPositions, sheetCorners, sheetSegments } = arrays;
  const sheet = new Sheet(sheetPositions, colours, pieceOf, sheetCorners, sheetSegments, kTube * spacing);
  const values = Float32Array.from(sheet.order, (t) => shares[pieceOf[t]]);
  return {
    drawn: sheet,
    values,
    name: 'Sheet pieces',
    symbol: 'share ≥',
    curve: 3, // most are small
    low: 0,
    // Joining and placing may have split off pieces below the operator's threshold: then 0, the whole sheet.
    first: shares.every((share) => share >= threshold) ? threshold : 0,
    keeps: (value, least) => value >= least,
    describe(elements, least) {
      let triangles = 0;
      for (let place = 0; place < elements; ++place) triangles += sheet.isTriangle(place) ? 1 : 0;
      const segments = elements - triangles;
      const curves = segments ? ` and ${whole(segments)} segments of curves` : '';
      const kept = prefixLength(shares, null, (share) => share >= least);
      const pieces = shares.length === 1 ? 'one piece' : `${whole(kept)} of ${whole(shares.length)} pieces`;
      return shares.length === 0 ? 'the sheet is empty' : `${whole(triangles)} triangles${curves} in ${pieces}`;
    },
  };
}

function makeBalls({ arrays, highestShare, cell, lowestThreshold, threshold }, positions) {
  const colours = coloursOf(arrays.pointShares, highestShare);
  const values = arrays.pointDivergences; // descending, see page.cc
  return {
    drawn: new BallCloud(positions, colours, cell),
    values,
    name: 'Shock threshold',
    symbol: '|H| >',
    curve: 1,
    low: Math.max(lowestThreshold, threshold / 10),
    first: threshold,
    keeps: (value, least) => value > least,
    describe: (points) => `${whole(points)} skeleton points`,
  };
}

// positions: of the sample points, page units.
export function makeSkeleton(page, positions) {
  const made = page.arrays.sheetCorners ? makeSheet(page) : makeBalls(page, positions);
  const { drawn, values, low, keeps } = made;
  return {
    ...made,
    high: values.length ? Math.max(values[0], low) : low,
    total: values.length,
    // Returns how many points, or triangles and segments, are shown.
    show(threshold) {
      const count = prefixLength(values, null, (value) => keeps(value, threshold));
      drawn.showFirst(count);
      return count;
    },
  };
}

// The points of the eroded solid by descending E; on a thinned page only the evenly spread ones.
// `count(share)`: how many have E >= share of v0.
export function makeErosion({ arrays, thinning }) {
  const { pointShares: shares, pointSteps: steps } = arrays;
  const { holds } = sublattice(thinning);
  const order = descending(shares).filter((p) => holds(steps[3 * p], steps[3 * p + 1], steps[3 * p + 2]));
  return {
    order,
    total: order.length,
    count: (share) => prefixLength(shares, order, (value) => value >= share),
  };
}

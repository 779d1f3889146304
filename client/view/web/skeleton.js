// The two skeletons that a page can hold, behind one face: sample points with their |H|, or a sheet with the
// strength of the shock.  Both come, or are put, in the order of what the threshold slider compares.
import { BallCloud } from './clouds.js';
import { coloursOf } from './colours.js';
import { descending, prefixLength } from './decode.js';
import { Sheet } from './sheet.js';
import { sublattice } from './shell.js';

function makeSheet({ arrays, highestShare }) {
  const colours = coloursOf(arrays.sheetShares, highestShare);
  const sheet = new Sheet(arrays.sheetPositions, colours, arrays.sheetStrengths, arrays.sheetCorners);
  const values = sheet.strengths;
  return {
    drawn: sheet,
    values,
    order: null,
    items: 'triangles of the sheet',
    symbol: 'strength',
    // Below the weakest triangle: the page begins with the whole sheet.
    low: values.length ? Math.max(0, (Math.ceil(100 * values[values.length - 1]) - 1) / 100) : 0,
  };
}

function makeBalls({ arrays, highestShare, pointStep, lowestThreshold, threshold }, positions) {
  const colours = coloursOf(arrays.pointShares, highestShare);
  const values = arrays.pointDivergences; // descending, see page.cc
  return {
    drawn: new BallCloud(positions, colours, 0.55 * pointStep),
    values,
    order: null,
    items: 'skeleton points',
    symbol: '|H|',
    low: Math.max(lowestThreshold, threshold / 10),
  };
}

// positions: of the sample points, page units.
export function makeSkeleton(page, positions) {
  const made = page.arrays.sheetCorners ? makeSheet(page) : makeBalls(page, positions);
  const { drawn, values, low } = made;
  return {
    ...made,
    high: values.length ? Math.max(values[0], low) : low,
    total: values.length,
    // Strictly above, as the threshold is defined.  Returns how many are shown.
    show(threshold) {
      const count = prefixLength(values, null, (value) => value > threshold);
      drawn.showFirst(count);
      return count;
    },
  };
}

// The points of the eroded solid by descending E: of a thinned page those that are evenly spread.
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

// Marked edges of a body: the defects of its mesh, or those that its repair has mended.
import { Sheet } from './sheet.js';

const kRadius = 0.004; // page units: a 500th of the longest side
const kColour = [219, 26, 31, 255];

/**
 * Tubes round the marked edges, possibly none.
 * @param {ModelFacts} model
 * @param {import('./clip.js').Clip} clip
 * @returns {Sheet}
 */
export function makeMarks({ arrays }, clip) {
  const ends = arrays.markPositions.length / 3;
  const colours = Uint8Array.from({ length: 4 * ends }, (_, i) => kColour[i % 4]);
  const segments = Uint32Array.from({ length: ends }, (_, end) => end);
  const none = new Uint32Array(0);
  const marks = new Sheet(arrays.markPositions, colours, new Uint32Array(ends / 2), none, segments, kRadius, clip);
  marks.showFirst(ends / 2);
  return marks;
}

// Reads what the page was written with (client/view/page.cc): a JSON document and one block of little-endian
// arrays in base64.
const kTypes = { u16: Uint16Array, u32: Uint32Array, f32: Float32Array, i8: Int8Array };

/** @param {string} base64 */
function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

/**
 * The facts of the page; those of each of its models with arrays under `arrays`, absent ones empty.
 * @param {Document} document
 * @returns {Page}
 */
export function decodePage(document) {
  /** @type {(id: string) => any} */
  const element = (id) => document.getElementById(id);
  const facts = JSON.parse(element('facts').textContent);
  const bytes = bytesOf(element('arrays').textContent.trim());
  const models = facts.models.map((model) => {
    const arrays = {};
    for (const [name, [type, offset, count]] of Object.entries(model.arrays)) {
      arrays[name] = new kTypes[type](bytes.buffer, offset, count);
    }
    return { ...model, arrays };
  });
  return { ...facts, models };
}

// Positions in page coordinates: the body's box about the origin, the longest side of all from -1 to 1.
function positionsOf(steps, { origin, axes }) {
  const positions = new Float32Array(steps.length);
  for (let p = 0; p < steps.length; p += 3) {
    for (let c = 0; c < 3; ++c) {
      positions[p + c] =
        origin[c] + steps[p] * axes[0][c] + steps[p + 1] * axes[1][c] + steps[p + 2] * axes[2][c];
    }
  }
  return positions;
}

/**
 * Of the vertices of the body's surface.
 * @param {ModelFacts} model
 * @returns {Float32Array}
 */
export const meshPositions = (model) => positionsOf(model.arrays.meshSteps, model.meshGrid);
/**
 * Of the sample points.
 * @param {ModelFacts} model
 * @returns {Float32Array}
 */
export const pointPositions = (model) => positionsOf(model.arrays.pointSteps, model.pointGrid);
/**
 * Of the eroded solid at a level, by its place among the levels.
 * @param {ModelFacts} model
 * @param {number} level
 * @returns {Float32Array}
 */
export const erodedPositions = (model, level) => positionsOf(model.arrays[`eroded${level}Steps`], model.meshGrid);

/**
 * How many of `values`, taken in `order`, satisfy `inside`, when all that do come first (binary search).
 * @param {ArrayLike<number>} values
 * @param {ArrayLike<number> | null} order
 * @param {(value: number) => boolean} inside
 * @returns {number}
 */
export function prefixLength(values, order, inside) {
  let low = 0;
  let high = order ? order.length : values.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (inside(values[order ? order[middle] : middle])) low = middle + 1;
    else high = middle;
  }
  return low;
}

/**
 * Indices of `values` by descending value.
 * @param {Float32Array | Int32Array} values
 * @returns {Uint32Array}
 */
export function descending(values) {
  const order = Uint32Array.from(values.keys());
  return order.sort((a, b) => values[b] - values[a] || a - b);
}

// What stands in the panel beside the picture: warnings, facts, one threshold slider for each kind of skeleton.
import { rounded, whole } from './numbers.js';

const element = (name, textContent, properties = {}) =>
  Object.assign(document.createElement(name), { textContent, ...properties });

function factsOf(model) {
  const box = model.box.map((side) => rounded(side, 4)).join(' × ');
  if (model.job === '') return { triangles: whole(model.triangles), box };
  return {
    triangles: whole(model.triangles),
    points: whole(model.points),
    directions: model.minimum === 'infimum' ? 'all' : whole(model.directions),
    spacing: rounded(model.spacing, 5),
    v0: rounded(model.volume),
    frame: model.frame,
    job: model.job.slice(0, 8),
    ...Object.fromEntries(model.pieces),
    operator: model.operator,
    box,
  };
}

/**
 * One column for each model.
 * @param {HTMLElement} list
 * @param {ModelFacts[]} models
 */
export function showFacts(list, models) {
  const facts = models.map(factsOf);
  const names = [...new Set(facts.flatMap((of) => Object.keys(of)))];
  list.className = models.length > 1 ? 'two' : 'one';
  if (models.length > 1) list.append(element('dt', ''), ...'AB'.split('').map((name) => element('dd', name)));
  for (const name of names) {
    list.append(element('dt', name), ...facts.map((of) => element('dd', of[name] || '–')));
  }
}

/**
 * Nothing when there is nothing to warn of.
 * @param {HTMLElement} list
 * @param {ModelFacts[]} models
 */
export function showWarnings(list, models) {
  const lines = models.flatMap(({ warnings }, i) =>
    warnings.map((warning) => (models.length > 1 ? `${'AB'[i]}: ${warning}` : warning)),
  );
  list.replaceChildren(...lines.map((line) => element('li', line)));
  list.hidden = lines.length === 0;
}

/**
 * The section of a slider once more, for model `number` (0 is there already).
 * @param {HTMLElement} section
 * @param {number} number
 * @returns {HTMLElement}
 */
export function sectionFor(section, number) {
  if (number === 0) return section;
  const copy = /** @type {any} */ (section.cloneNode(true));
  copy.id = `${section.id}-${number + 1}`;
  for (const part of copy.querySelectorAll('[id]')) part.id = `${part.id}-${number + 1}`;
  for (const label of copy.querySelectorAll('[for]')) label.htmlFor = `${label.htmlFor}-${number + 1}`;
  section.after(copy);
  return copy;
}

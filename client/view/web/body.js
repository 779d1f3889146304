// What the body's colours tell: nothing, its parts with their table, or its thickness.
import { rounded } from './numbers.js';
import { erosionScale, labelLegend, thicknessScale } from './overlay.js';

const kOpacity = { '': 20, part: 70, thickness: 100 }; // per cent on the slider when it is chosen
const kColumns = ['', 'part', 'volume', 'length', 'radius'];

/** @type {(id: string) => any} */
const element = (id) => document.getElementById(id);
const made = (name, properties) => Object.assign(document.createElement(name), properties);

const cssOf = (colour) => `rgb(${colour.map((c) => Math.round(255 * c))})`;

/** The choice of colours, the table of parts, and the legend. */
export class Body {
  /**
   * changed(opacity): another choice, with the opacity that goes with it, or null for the one that is.
   * @param {Page} page
   * @param {import('./model.js').Model[]} models
   * @param {(opacity: number | null) => void} changed
   */
  constructor(page, models, changed) {
    this.page = page;
    this.models = models.filter(({ facts }) => facts.parts.length > 0);
    this.changed = changed;
    const most = (name) => Math.max(0, ...this.models.map(({ facts }) => facts.thickness[name]));
    this.thickness = { highest: most('highest'), greatest: most('greatest') };
    this.select = element('body-colour');
    this.select.parentElement.hidden = this.models.length === 0;
    this.select.addEventListener('change', () => this.choose(this.select.value));
    element('parts').append(...this.models.map((model) => this.tableOf(model, models)));
    this.show('');
  }

  get chosen() {
    return this.select.value;
  }

  // As the user does.
  choose(what) {
    this.show(what);
    this.changed(kOpacity[this.chosen]);
  }

  // what: a value of the choice; others are nothing.
  show(what) {
    this.select.value = what in kOpacity && this.models.length > 0 ? what : '';
    for (const model of this.models) model.colourBody(this.chosen, 0, this.thickness.highest);
    element('parts').hidden = this.chosen !== 'part';
    labelLegend(element('legend'), this.chosen === 'thickness' ? thicknessScale(this.thickness) : erosionScale(this.page));
  }

  tableOf(model, models) {
    const table = made('table', { className: 'parts' });
    if (models.length > 1) table.append(made('caption', { textContent: 'AB'[models.indexOf(model)] }));
    const head = made('tr', {});
    head.append(...kColumns.map((textContent) => made('th', { textContent, scope: 'col' })));
    table.append(head, ...model.facts.parts.map((part, p) => this.rowOf(model, part, p + 1)));
    table.addEventListener('pointerleave', () => this.highlight(model, 0));
    return table;
  }

  rowOf(model, part, number) {
    const row = made('tr', { tabIndex: 0 });
    const swatch = made('td', { className: 'swatch' });
    swatch.style.setProperty('--part', cssOf(part.colour));
    const texts = [`${number} ${part.kind}`, `${rounded(100 * part.share, 3)} %`, rounded(part.length, 4), rounded(part.radius, 3)];
    row.append(swatch, ...texts.map((textContent) => made('td', { textContent })));
    for (const event of ['pointerenter', 'focus']) row.addEventListener(event, () => this.highlight(model, number));
    row.addEventListener('blur', () => this.highlight(model, 0));
    return row;
  }

  highlight(model, number) {
    model.colourBody(this.chosen, number, this.thickness.highest);
    this.changed(null);
  }
}

// What is asked of a mesh: the form of a new job.
import { call } from './api.js';
import { announce, button, h, numberField, setText } from './elements.js';
import { counted, editable, measure, typed } from './numbers.js';
import { session } from './session.js';

const kTyping = 300; // milliseconds after a key until the lattice is counted
const kAgain = 500; // milliseconds until a count that found no place is tried again
const kNoPlace = 429; // status: what was asked for before is still worked on
// The sets of directions that the form has words for.
const kSets = /^(triangles\+sphere|triangles|sphere|random)(?::(\d+)(?::(\d+))?)?$/;

/** Sample points unless another number is asked for. */
export const kUsualPoints = 100000;

const kLongestName = 200; // bytes, by the protocol
/** @type {(text: string) => number} */
const bytesOf = (text) => new TextEncoder().encode(text).length;

/**
 * What a job of a file is called: "body" of "body.off.gz", as far as there is room.
 * @param {string} file
 * @returns {string}
 */
export function jobName(file) {
  const letters = [...file.replace(/\.(gz|zst)$/i, '').replace(/\.[^.]*$/, '')];
  while (bytesOf(letters.join('')) > kLongestName) letters.pop();
  return letters.join('');
}

/**
 * A control with its label, and a line of help.
 * @param {string} id
 * @param {string} label
 * @param {any} control
 * @param {string} [help]
 * @returns {any}
 */
export const field = (id, label, control, help) =>
  h('div', {}, h('label', { for: id }, label), control, help && h('p', { class: 'small', id: `${id}-help` }, help));

// texts: by the values that they stand for.
const choice = (id, texts) =>
  h('select', { id }, Object.entries(texts).map(([value, text]) => h('option', { value }, text)));

const newRequest = () => crypto.getRandomValues(new Uint32Array(4)).join('-');

/** What is asked of a mesh. */
export class SubmitForm {
  /** @param {any} mesh as the service tells of it */
  constructor(mesh) {
    this.mesh = mesh;
    this.seed = '1'; // of directions at random; as text, for it may have 20 digits
    this.given = 'points'; // which of the two was typed
    this.name = h('input', { id: 'name', type: 'text', autocomplete: 'off', value: jobName(mesh.name) });
    this.points = numberField('points', { value: kUsualPoints });
    this.spacing = numberField('spacing');
    this.lattice = h('p', { id: 'lattice', role: 'status' });
    this.advice = h('div', { id: 'advice', role: 'status', hidden: true });
    this.directions = choice('directions', {
      triangles: 'the mesh’s own normals',
      sphere: 'evenly from all sides',
      'triangles+sphere': 'both of these',
      random: 'at random',
    });
    this.howMany = numberField('how-many', { value: 5000 });
    this.howManyField = field('how-many', 'How many', this.howMany);
    this.howManyField.hidden = true;
    this.minimum = choice('minimum', session.words.minima);
    this.frame = choice('frame', session.words.frames);
    this.operator = choice('operator', session.words.operators);
    this.operator.value = session.usual.operator;
    this.threshold = numberField('threshold', { placeholder: 'usual' });
    this.problem = h('p', { class: 'error', role: 'alert', hidden: true });
    this.submit = h('button', { type: 'submit', class: 'primary', id: 'submit' }, 'Compute the skeleton');
    this.element = this.build();
    this.listen();
    this.typed('points');
    this.advise();
  }

  build() {
    return h(
      'form',
      { class: 'card', novalidate: true },
      h('h2', {}, 'What to compute'),
      h(
        'div',
        { class: 'fields' },
        field('name', 'Name', this.name),
        field('points', 'Sample points', this.points, 'More are finer, and take longer.'),
        field('spacing', 'or their spacing', this.spacing, 'In units of the mesh.'),
      ),
      this.lattice,
      this.advice,
      h(
        'details',
        {},
        h('summary', {}, 'Directions, lattice and operator'),
        h(
          'div',
          { class: 'fields' },
          field('directions', 'Directions of the planes', this.directions, 'Cubes and other shapes with few normals need some from all sides.'),
          this.howManyField,
          field('minimum', 'Least over', this.minimum),
          field('frame', 'Lattice along', this.frame),
          field('operator', 'Skeleton by', this.operator),
          field('threshold', 'with the threshold', this.threshold),
        ),
      ),
      this.problem,
      h('div', { class: 'row end' }, this.submit),
    );
  }

  /**
   * Asks for what a job was asked for; a set of directions that the form has no words for stays the usual one.
   * @param {Job} job
   */
  like({ params, skeleton }) {
    const { sampling, directions, frame, minimum } = params;
    const [, set, many, seed] = kSets.exec(directions) || [];
    if (set) this.directions.value = set;
    if (many) this.howMany.value = many;
    this.seed = seed || '1';
    this.howManyField.hidden = this.directions.value === 'triangles';
    for (const [control, value] of [[this.minimum, minimum], [this.frame, frame], [this.operator, skeleton.operator]]) {
      if (value) control.value = value;
    }
    this.threshold.value = String(skeleton.threshold || '');
    const which = sampling?.spacing ? 'spacing' : 'points';
    this[which].value = String(sampling?.spacing || sampling?.target_points || kUsualPoints);
    this.typed(which);
    const usual = set === 'triangles' && !skeleton.threshold && [minimum, frame, skeleton.operator].every((word, i) =>
      !word || word === [session.usual.minimum, session.usual.frame, session.usual.operator][i]);
    this.element.querySelector('details').open = !usual;
    this.advise();
  }

  // What the service advises is of the directions that are asked for unless others are chosen.
  advise() {
    const advice = this.directions.value === 'triangles' ? this.mesh.advice || [] : [];
    this.advice.replaceChildren(...advice.map(({ message, to_try: settings }) => h('p', {}, `Note: ${message}. `, this.adopting(settings))));
    this.advice.hidden = advice.length === 0;
  }

  adopting(settings) {
    const found = settings.find((setting) => setting.name === 'directions');
    const [, set, many] = kSets.exec(found?.value || '') || [];
    if (!many) return null;
    return button('Take these', () => {
      this.directions.value = set;
      this.howMany.value = many;
      this.howManyField.hidden = false;
      this.element.querySelector('details').open = true;
      this.advise();
      this.directions.focus();
    });
  }

  listen() {
    this.points.addEventListener('input', () => this.typed('points'));
    this.spacing.addEventListener('input', () => this.typed('spacing'));
    this.frame.addEventListener('change', () => this.typed(this.given));
    this.directions.addEventListener('change', () => {
      this.howManyField.hidden = this.directions.value === 'triangles';
      this.advise();
    });
    this.operator.addEventListener('change', () => {
      this.threshold.value = ''; // it was of the other one
    });
    this.element.addEventListener('submit', (event) => {
      event.preventDefault();
      this.send();
    });
  }

  // The other of the two follows at once by the volume, and then as the lattice counts: in the same words, so
  // that the button below does not move when the count comes.
  typed(which) {
    this.given = which;
    const value = typed(this[which].value);
    clearTimeout(this.timer);
    if (this.counting) this.counting.abort();
    if (!(value > 0)) {
      setText(this.lattice, `${which === 'points' ? 'Sample points' : 'Their spacing'}: a number above 0.`);
      return;
    }
    const { volume } = this.mesh.facts;
    if (which === 'points') this.spacing.value = editable(Math.cbrt(volume / value));
    else this.points.value = String(Math.max(0, Math.round(volume / value ** 3)));
    this.say('about ', typed(this.points.value), typed(this.spacing.value));
    this.timer = setTimeout(() => this.count(which, value), kTyping);
  }

  say(about, points, spacing) {
    setText(this.lattice, `${about}${counted(points, 'sample point')} at spacing ${measure(spacing)}`);
  }

  async count(which, value) {
    this.counting = new AbortController();
    const query = new URLSearchParams({ [which]: value, frame: this.frame.value });
    try {
      const found = await call('GET', `/api/meshes/${this.mesh.mesh}/lattice?${query}`, undefined, this.counting.signal);
      const other = which === 'points' ? this.spacing : this.points;
      // A field that has the focus is about to be typed in: its selection must not change.
      if (other !== document.activeElement) other.value = which === 'points' ? editable(found.spacing) : String(found.points);
      this.say(found.counted ? '' : 'about ', found.points, found.spacing);
    } catch (error) {
      if (error.status === kNoPlace) this.timer = setTimeout(() => this.count(which, value), kAgain);
      else if (error.name !== 'AbortError') setText(this.lattice, error.message);
    }
  }

  directionSet() {
    const many = this.directions.value === 'triangles' ? 1 : typed(this.howMany.value);
    if (!(many >= 1 && Number.isInteger(many))) throw new Error('The number of directions must be a whole number above 0.');
    const sets = {
      triangles: 'triangles',
      sphere: `sphere:${many}`,
      'triangles+sphere': `triangles+sphere:${many}`,
      random: `random:${many}:${this.seed}`,
    };
    return sets[this.directions.value];
  }

  nameAsked() {
    const name = this.name.value.trim();
    const over = bytesOf(name) - kLongestName;
    if (over > 0) throw new Error(`The name is ${counted(over, 'byte')} too long: it may have ${kLongestName}, and letters beyond a to z are two to four each.`);
    return name;
  }

  thresholdAsked() {
    const text = this.threshold.value.trim();
    if (text === '') return undefined;
    const threshold = typed(text);
    if (!(threshold > 0)) throw new Error('The threshold must be a number above 0, or empty for the usual one.');
    return threshold;
  }

  asked() {
    return {
      mesh: this.mesh.mesh,
      [this.given]: typed(this[this.given].value) || 0,
      directions: this.directionSet(),
      frame: this.frame.value,
      minimum: this.minimum.value,
      operator: this.operator.value,
      threshold: this.thresholdAsked(),
      name: this.nameAsked(),
    };
  }

  // What is asked again after an answer was lost is the same request; anything else is another.
  requestOf(asked) {
    const text = JSON.stringify(asked);
    if (text !== this.lastAsked) this.requestId = newRequest();
    this.lastAsked = text;
    return { ...asked, request_id: this.requestId };
  }

  async send() {
    this.problem.hidden = true;
    this.submit.disabled = true;
    try {
      const answer = await call('POST', '/api/jobs', this.requestOf(this.asked()));
      this.lastAsked = null;
      if (answer.existed) {
        this.problem.replaceChildren('The same was submitted before: ', h('a', { href: `#job/${answer.id}` }, answer.name), '. Other parameters above make another job of it.');
        this.problem.hidden = false;
        return;
      }
      announce(`${answer.name} was submitted.`);
      location.hash = `#job/${answer.id}`;
    } catch (error) {
      this.problem.textContent = error.message;
      this.problem.hidden = false;
    } finally {
      this.submit.disabled = false;
    }
  }
}

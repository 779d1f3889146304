// A new job: a mesh, what it is, and what is asked of it.
import { call, jobPath, upload } from './api.js';
import { filesIn } from './dropped.js';
import { showInteractive } from './dialogs.js';
import { announce, button, byId, facts, h, setText } from './elements.js';
import { bytes, count, counted, editable, measure } from './numbers.js';
import { session } from './session.js';

const kTypes = ['.off', '.ply', '.obj', '.stl', '.vtp', '.glb', '.gltf', '.3mf', '.nrrd', '.mha', '.nii', '.gz', '.zst'];
const kVoxels = /\.(nrrd|mha|nii)(\.gz|\.zst)?$/i;
const kUsualPoints = 100000;
const kTyping = 300; // milliseconds after a key until the lattice is counted
const kAgain = 500; // milliseconds until a count that found no place is tried again
const kNoPlace = 429; // status: what was asked for before is still worked on

// "body" of "body.off.gz".
const jobName = (file) => file.replace(/\.(gz|zst)$/i, '').replace(/\.[^.]*$/, '');

function meshFacts(f) {
  const size = f.bbox_size ? [['Size', f.bbox_size.map(measure).join(' × ')]] : [];
  const solid = f.computable
    ? [['Volume', measure(f.volume)], ['Solids', count(f.solids)], ['Cavities', count(f.cavities)], ['Handles', count(f.genus)]]
    : [];
  return facts([
    ['File', `${f.file}, ${bytes(f.bytes)}`],
    ['Triangles', count(f.triangles)],
    ['Vertices', count(f.vertices)],
    ...(f.holes?.count ? [['Holes', `${count(f.holes.count)}, the longest ${measure(f.holes.longest[0].length)} round`]] : []),
    ...solid,
    ...size,
  ]);
}

// Loaded before it is shown, so that nothing below it moves from under a finger.
async function loadedPicture(mesh) {
  if (!mesh.picture) return null;
  const image = h('img', { class: 'picture', src: mesh.picture, alt: `${mesh.name} from the front, the side and above` });
  await image.decode().catch(() => {}); // the text beside it stands for one that does not load
  return image;
}

/** What is seen at #new. */
export class NewJob {
  /** @param {string} [job] whose mesh it is, to be computed with other parameters */
  constructor(job) {
    this.title = 'New job';
    this.file = h('input', { id: 'file', type: 'file', accept: kTypes.join(','), multiple: true, class: 'visually-hidden' });
    this.drop = h(
      'label',
      { class: 'drop', for: 'file' },
      h('strong', {}, 'Drop a mesh here, or choose a file'),
      h('span', { class: 'small' }, `A closed surface as ${kTypes.join(', ')}, at most ${bytes(session.max_mesh_bytes)}; several, or folders of them, become a job each`),
    );
    this.sent = h('progress', { max: 1, value: 0, hidden: true, 'aria-label': 'Upload' });
    this.status = h('p', { class: 'small', role: 'status' });
    this.problem = h('p', { class: 'error', role: 'alert', hidden: true });
    this.found = h('div', {});
    this.form = h('div', {});
    this.element = h(
      'section',
      {},
      h('p', {}, h('a', { href: '#jobs' }, '← All jobs')),
      h('h1', { tabindex: -1 }, 'New job'),
      h('div', { class: 'card' }, this.file, this.drop, this.sent, this.status, this.problem),
      h('div', { class: 'beside' }, this.found, this.form),
    );
    this.file.addEventListener('change', () => this.takeAll([...this.file.files]));
    this.listenForDrops();
    if (job) this.takeFromJob(job);
  }

  listenForDrops() {
    const over = (on) => (event) => {
      event.preventDefault();
      this.drop.classList.toggle('over', on);
    };
    this.drop.addEventListener('dragenter', over(true));
    this.drop.addEventListener('dragover', over(true));
    this.drop.addEventListener('dragleave', over(false));
    this.drop.addEventListener('drop', (event) => {
      over(false)(event);
      filesIn(event.dataTransfer, kTypes).then((files) => this.takeAll(files));
    });
  }

  /** @param {string} id */
  async takeFromJob(id) {
    this.status.textContent = 'Fetching the mesh of the job …';
    try {
      const job = await call('GET', jobPath(id));
      const made = await call('POST', jobPath(id, '/results'), { artefact: 'mesh', format: '.off' });
      const answer = await fetch(made.href);
      if (!answer.ok) throw new Error('its mesh could not be fetched');
      await this.take(new File([await answer.blob()], `${job.name}.off`));
    } catch (error) {
      this.status.textContent = '';
      this.complain(error.message);
    }
  }

  /** @param {File[]} files one to be looked at, several to be computed as they are */
  async takeAll(files) {
    if (files.length === 0) this.complain(`There is no file of the kinds ${kTypes.join(', ')}.`);
    if (files.length === 1) await this.take(files[0]);
    if (files.length < 2) return;
    this.complain('');
    const list = h('ul', { class: 'notes', id: 'several' });
    this.found.replaceChildren(h('section', { class: 'card' }, h('h2', {}, `${counted(files.length, 'file')}, a job each`), list));
    this.form.replaceChildren();
    for (const file of files) {
      const line = h('li', {}, `${file.name}: sending …`);
      list.append(line);
      line.replaceChildren(...(await this.submitted(file)));
    }
    announce(`${counted(files.length, 'file')} done`);
  }

  // What came of one of several files.
  async submitted(file) {
    try {
      let mesh = await this.sentFile(file);
      if (!mesh.mesh) mesh = await this.sentFile(file, { repair: 'auto' });
      if (!mesh.mesh) throw new Error(mesh.error);
      const answer = await call('POST', '/api/jobs', { mesh: mesh.mesh, points: kUsualPoints, name: jobName(file.name) });
      return [h('a', { href: `#job/${answer.id}` }, answer.name), answer.existed ? ' was there already' : ' is submitted'];
    } catch (error) {
      return [h('span', { class: 'error' }, `${file.name}: ${error.message}`)];
    }
  }

  /**
   * @param {File} file
   * @param {Asked} asked
   */
  async sentFile(file, asked = {}) {
    if (file.size === 0) throw new Error('the file is empty');
    const most = session.max_mesh_bytes;
    if (file.size > most) throw new Error(`it has ${bytes(file.size)}; the server takes at most ${bytes(most)}`);
    this.sent.hidden = false;
    this.status.textContent = `Sending ${file.name} …`;
    try {
      const told = asked.repair ? 'Repairing the mesh …' : 'Looking at the mesh …';
      const progress = (share) => {
        this.sent.value = share;
        if (share === 1) setText(this.status, told);
      };
      return await upload(file, progress, '/api/meshes', asked);
    } finally {
      this.status.textContent = '';
      this.sent.hidden = true;
      this.file.value = ''; // the same file may be chosen again
    }
  }

  complain(message) {
    this.problem.textContent = message || '';
    this.problem.hidden = !message;
  }

  /**
   * @param {File} file
   * @param {Asked} asked
   */
  async take(file, asked = {}) {
    this.complain('');
    this.found.replaceChildren();
    this.form.replaceChildren();
    try {
      const mesh = await this.sentFile(file, asked);
      if (mesh.facts) {
        this.show(mesh, file, asked, await loadedPicture(mesh));
        return;
      }
      this.complain(`${file.name} cannot be read: ${mesh.error}`);
      if (kVoxels.test(file.name)) this.askIsovalue(file, asked);
    } catch (error) {
      this.complain(`${file.name} cannot be read: ${error.message}`);
    }
  }

  // Of an image of voxels.
  askIsovalue(file, asked) {
    const value = numberField('isovalue', { min: undefined, value: asked.isovalue });
    const take = () => {
      if (value.value) this.take(file, { isovalue: value.value });
    };
    this.found.replaceChildren(
      h(
        'form',
        {
          class: 'card',
          novalidate: true,
          onsubmit: (event) => {
            event.preventDefault();
            take();
          },
        },
        h('h2', {}, 'An image of voxels'),
        field('isovalue', 'Value at the surface of the solid', value),
        h('div', { class: 'row end' }, h('button', { type: 'submit', class: 'primary', id: 'make-surface' }, 'Make its surface')),
      ),
    );
    value.focus();
  }

  /** @param {File} file */
  async turn(file) {
    this.complain('');
    try {
      const { href } = await upload(file, () => {}, '/api/meshes/view', this.asked);
      showInteractive(href, file.name, []);
    } catch (error) {
      this.complain(error.message);
    }
  }

  show(mesh, file, asked, picture) {
    this.asked = asked;
    const { facts: f } = mesh;
    const defects = (f.defects || []).map((defect) => h('li', { class: 'defect' }, defect.message));
    const notes = (f.notes || []).map((note) => h('li', { class: note.severity }, note.message));
    this.found.replaceChildren(
      h(
        'section',
        { class: 'card', id: 'found' },
        h(
          'div',
          { class: 'row head' },
          h('h2', { tabindex: -1, id: 'found-heading' }, mesh.mesh ? 'This is the mesh' : 'This mesh bounds no solid'),
          button('Turn it', () => this.turn(file), { id: 'turn-mesh' }),
        ),
        mesh.error && h('p', { class: 'error' }, mesh.error),
        h('ul', { class: 'notes' }, defects, notes),
        !mesh.mesh &&
          h(
            'div',
            { class: 'row wrap' },
            button('Fill its holes', () => this.take(file, { ...asked, repair: 'fill' }), { id: 'fill-holes', class: 'primary' }),
            button('Wrap it in a new surface', () => this.take(file, { ...asked, repair: 'wrap' }), { id: 'wrap' }),
          ),
        picture,
        meshFacts(f),
      ),
    );
    if (mesh.mesh) this.form.replaceChildren(new SubmitForm(mesh).element);
    byId('found-heading').focus();
  }
}

const field = (id, label, control, help) =>
  h('div', {}, h('label', { for: id }, label), control, help && h('p', { class: 'small', id: `${id}-help` }, help));

// texts: by the values that they stand for.
const choice = (id, texts) =>
  h('select', { id }, Object.entries(texts).map(([value, text]) => h('option', { value }, text)));

const numberField = (id, attributes) =>
  h('input', { id, type: 'number', min: 0, step: 'any', inputmode: 'decimal', ...attributes });

const newRequest = () => crypto.getRandomValues(new Uint32Array(4)).join('-');

// What is asked of a mesh.
class SubmitForm {
  constructor(mesh) {
    this.mesh = mesh;
    this.requestId = newRequest();
    this.given = 'points'; // which of the two was typed
    this.name = h('input', { id: 'name', type: 'text', maxlength: 60, autocomplete: 'off', value: jobName(mesh.name) });
    this.points = numberField('points', { step: 1, value: kUsualPoints });
    this.spacing = numberField('spacing', {});
    this.lattice = h('p', { id: 'lattice', role: 'status' });
    this.directions = choice('directions', {
      triangles: 'the mesh’s own normals',
      sphere: 'evenly from all sides',
      'triangles+sphere': 'both of these',
      random: 'at random',
    });
    this.howMany = numberField('how-many', { min: 1, step: 1, value: 5000 });
    this.howManyField = field('how-many', 'How many', this.howMany);
    this.howManyField.hidden = true;
    this.minimum = choice('minimum', session.words.minima);
    this.frame = choice('frame', session.words.frames);
    this.operator = choice('operator', session.words.operators);
    this.operator.value = session.usual.operator;
    this.problem = h('p', { class: 'error', role: 'alert', hidden: true });
    this.submit = h('button', { type: 'submit', class: 'primary', id: 'submit' }, 'Compute the skeleton');
    this.element = this.build();
    this.listen();
    this.typed('points');
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
        ),
      ),
      this.problem,
      h('div', { class: 'row end' }, this.submit),
    );
  }

  listen() {
    this.points.addEventListener('input', () => this.typed('points'));
    this.spacing.addEventListener('input', () => this.typed('spacing'));
    this.frame.addEventListener('change', () => this.typed(this.given));
    this.directions.addEventListener('change', () => {
      this.howManyField.hidden = this.directions.value === 'triangles';
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
    const value = parseFloat(this[which].value);
    clearTimeout(this.timer);
    if (this.counting) this.counting.abort();
    if (!(value > 0)) {
      setText(this.lattice, 'Give a number above 0.');
      return;
    }
    const { volume } = this.mesh.facts;
    if (which === 'points') this.spacing.value = editable(Math.cbrt(volume / value));
    else this.points.value = String(Math.max(0, Math.round(volume / value ** 3)));
    this.say('about ', parseFloat(this.points.value), parseFloat(this.spacing.value));
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
    const many = Math.max(1, Math.round(parseFloat(this.howMany.value) || 0));
    const sets = {
      triangles: 'triangles',
      sphere: `sphere:${many}`,
      'triangles+sphere': `triangles+sphere:${many}`,
      random: `random:${many}:1`,
    };
    return sets[this.directions.value];
  }

  async send() {
    this.problem.hidden = true;
    this.submit.disabled = true;
    try {
      const answer = await call('POST', '/api/jobs', {
        mesh: this.mesh.mesh,
        [this.given]: parseFloat(this[this.given].value) || 0,
        directions: this.directionSet(),
        frame: this.frame.value,
        minimum: this.minimum.value,
        operator: this.operator.value,
        name: this.name.value.trim(),
        request_id: this.requestId,
      });
      this.requestId = newRequest(); // other parameters are another request
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

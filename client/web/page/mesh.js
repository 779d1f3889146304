// A new job: a mesh and what it is.
import { call, jobPath, upload } from './api.js';
import { filesIn } from './dropped.js';
import { showInteractive } from './dialogs.js';
import { announce, button, byId, facts, h, numberField, setText } from './elements.js';
import { bytes, count, counted, measure, typed } from './numbers.js';
import { session } from './session.js';
import { SubmitForm, field, jobName, kUsualPoints } from './submit_form.js';

const fileTypes = () => [...session.mesh_files, ...session.voxel_files, ...session.packed_files];

/** @param {string} name of a file */
function isVoxels(name) {
  const ending = (type) => ['', ...session.packed_files].some((packed) => name.toLowerCase().endsWith(type + packed));
  return session.voxel_files.some(ending);
}

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
    this.file = h('input', { id: 'file', type: 'file', accept: fileTypes().join(','), multiple: true, class: 'visually-hidden' });
    this.drop = h(
      'label',
      { class: 'drop', for: 'file' },
      h('strong', {}, 'Drop a mesh here, or choose a file'),
      h('span', { class: 'small' }, `A closed surface as ${fileTypes().join(', ')}, at most ${bytes(session.max_mesh_bytes)}; several, or folders of them, become a job each`),
    );
    this.sent = h('progress', { max: 1, value: 0, hidden: true, 'aria-label': 'Upload' });
    this.status = h('p', { class: 'small', role: 'status' });
    this.problem = h('p', { class: 'error', role: 'alert', hidden: true });
    /** @type {SubmitForm | null} */
    this.asks = null;
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

  // Nothing is to be known; but a private server leaves after a minute without calls.
  async ask(signal) {
    await call('GET', '/api/jobs?limit=1', undefined, signal);
    return false;
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
      filesIn(event.dataTransfer, fileTypes()).then((files) => this.takeAll(files));
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
      if (this.asks) this.asks.like(job);
    } catch (error) {
      this.status.textContent = '';
      this.complain(error.message);
    }
  }

  /** @param {File[]} files one to be looked at, several to be computed as they are */
  async takeAll(files) {
    if (files.length === 0) this.complain(`There is no file of the kinds ${fileTypes().join(', ')}.`);
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
      const answer = await call('POST', '/api/jobs', { mesh: mesh.mesh, points: kUsualPoints, name: jobName(mesh.name) });
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
    this.asks = null;
    this.drop.classList.remove('small');
    try {
      const mesh = await this.sentFile(file, asked);
      if (mesh.facts) {
        this.show(mesh, file, asked, await loadedPicture(mesh));
        return;
      }
      const first = isVoxels(file.name) && asked.isovalue === undefined && mesh.error.includes('isovalue');
      if (!first) this.complain(`${file.name} cannot be read: ${mesh.error}`);
      if (isVoxels(file.name)) this.askIsovalue(file, asked, first ? `${file.name} ${mesh.error}.` : '');
    } catch (error) {
      this.complain(`${file.name} cannot be read: ${error.message}`);
    }
  }

  // Of an image of voxels.
  askIsovalue(file, asked, why) {
    const value = numberField('isovalue', { inputmode: 'text', value: asked.isovalue });
    const take = () => {
      const isovalue = typed(value.value);
      if (Number.isNaN(isovalue)) this.complain('The value at the surface must be a number.');
      else this.take(file, { isovalue: String(isovalue) });
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
        why && h('p', {}, why),
        h('div', { class: 'fields' }, field('isovalue', 'Value at the surface of the solid', value)),
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
        // What there is to do about defects is told by the buttons below.
        mesh.error && defects.length === 0 && h('p', { class: 'error' }, mesh.error),
        h('ul', { class: 'notes' }, defects, notes),
        f.flat && h('p', { class: 'error' }, 'It is flat: give it a thickness first, by Blender’s Solidify, say.'),
        !mesh.mesh &&
          !f.flat &&
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
    this.drop.classList.add('small'); // the button of the form is to be in sight
    if (mesh.mesh) {
      this.asks = new SubmitForm(mesh);
      this.form.replaceChildren(this.asks.element);
    }
    byId('found-heading').focus({ preventScroll: true });
  }
}

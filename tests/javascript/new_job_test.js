// mesh.js: files that are submitted.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { NewJob } from '../../client/web/page/mesh.js';
import { session } from '../../client/web/page/session.js';
import { fakeElement, installDocument } from './fake_document.js';

installDocument();
document.getElementById = () => fakeElement();
globalThis.matchMedia = () => ({ matches: false });
Object.assign(session, { mesh_files: ['.off'], voxel_files: [], packed_files: ['.gz'], max_mesh_bytes: 1000 });

// Takes any mesh, and gives names as the service does: on one line.
class FakeUpload {
  upload = {};

  open(method, path) {
    this.query = new URL(path, 'http://page').searchParams;
  }

  send() {
    const name = this.query.get('name').replace(/[\n\t]/g, ' ');
    Object.assign(this, { status: 201, responseText: JSON.stringify({ mesh: `mesh of ${name}`, name }) });
    this.onload();
  }
}

test('a job of several files each has the name that the service has read', async () => {
  globalThis.XMLHttpRequest = FakeUpload;
  const asked = [];
  globalThis.fetch = async (path, { body }) => {
    asked.push(JSON.parse(body));
    return new Response(JSON.stringify({ id: 'j', name: asked.at(-1).name, existed: false }));
  };
  const view = new NewJob();
  view.drop.classList = { remove() {} };
  await view.takeAll([new File(['OFF'], 'a\tb.off'), new File(['OFF'], 'c.off.gz')]);
  assert.deepEqual(asked.map((one) => [one.mesh, one.name]), [['mesh of a b.off', 'a b'], ['mesh of c.off.gz', 'c']]);
});

test('the page of a new job makes a call now and then, so that a private server stays', async () => {
  const paths = [];
  globalThis.fetch = async (path) => {
    paths.push(path);
    return new Response(JSON.stringify({ jobs: [], more: false }));
  };
  assert.equal(await new NewJob().ask(new AbortController().signal), false);
  assert.deepEqual(paths, ['/api/jobs?limit=1']);
});

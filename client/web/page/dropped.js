// The files of what was dropped, those in folders, too.

const entries = (reader) => new Promise((resolve, reject) => reader.readEntries(resolve, reject));

// A reader gives a folder in parts, and an empty one at its end.
async function allEntries(folder) {
  const reader = folder.createReader();
  const all = [];
  for (;;) {
    const some = await entries(reader);
    if (some.length === 0) return all;
    all.push(...some);
  }
}

async function filesOf(entry, types) {
  if (entry.isDirectory) {
    const within = await Promise.all((await allEntries(entry)).map((one) => filesOf(one, types)));
    return within.flat();
  }
  if (!types.some((type) => entry.name.toLowerCase().endsWith(type))) return [];
  return [await new Promise((resolve, reject) => entry.file(resolve, reject))];
}

/**
 * All files that were dropped, whatever they are called; of folders those of the types, in the order of their names.
 * @param {DataTransfer} dropped
 * @param {string[]} types
 * @returns {Promise<File[]>}
 */
export async function filesIn(dropped, types) {
  const entry = (item) => item.webkitGetAsEntry?.();
  const folders = [...dropped.items].map(entry).flatMap((one) => (one?.isDirectory ? [one] : []));
  if (folders.length === 0) return [...dropped.files];
  const names = new Set(folders.map((folder) => folder.name));
  const files = [...dropped.files].filter((file) => !names.has(file.name));
  const within = (await Promise.all(folders.map((folder) => filesOf(folder, types)))).flat();
  return [...files, ...within.sort((a, b) => a.name.localeCompare(b.name))];
}

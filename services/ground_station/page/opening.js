// What both pages do first: their theme, and what the server gives or why it gives nothing.

const by = id => document.getElementById(id);

export function theme(name) {
  const dark = name ? name === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  document.documentElement.className = dark ? "dark" : "";
}

async function load() {
  let response, data;
  try {
    response = await fetch("/recording.json");
    data = await response.json();
  } catch (error) {
    throw new Error(`The server does not answer (${error.message}). Is \`cratous serve\` still running?`);
  }
  if (response.ok) return data;
  const rest = ["where", "item", "expected", "got"].filter(key => data[key]).map(key => `${key}: ${data[key]}`);
  throw new Error([`This log cannot be shown: ${data.error}`, ...rest].join("\n"));
}

// the token that let this page in is kept by a cookie: an address that is given to somebody else is without it
function forgetAccess() {
  const asked = new URLSearchParams(location.search);
  if (!asked.has("access")) return;
  asked.delete("access");
  history.replaceState(null, "", `${location.pathname}${asked.size ? `?${asked}` : ""}${location.hash}`);
}

// show: takes what the server gives, and draws it
export async function open(show) {
  forgetAccess();
  theme(new URLSearchParams(location.hash.slice(1)).get("theme"));
  try {
    const found = await load();
    by("message").hidden = true;
    by("station").hidden = false;
    show(found);
  } catch (error) {
    by("station").hidden = true;
    by("message").hidden = false;
    by("message").textContent = error.message;
    by("message").className = "error";
    by("message").setAttribute("role", "alert");
  }
}

// of whose messages a log is, and what is wrong with it
export function source(recording) {
  const log = recording.log;
  return [`${log.file} (${log.kind})`, recording.outcome, log.end && !log.digest ? log.end : "", log.missing ? `${log.missing} messages are missing` : "", recording.unread ? `${recording.unread} messages could not be decoded` : ""].filter(Boolean).join(" · ");
}

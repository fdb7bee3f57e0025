"""Move modules as map.txt says, in the checkout given as argument; rewrites every mention."""
import ast, re, subprocess, sys
from pathlib import Path
root = Path(sys.argv[1]).resolve()
pairs = []
for line in Path(__file__).with_name('map.txt').read_text().splitlines():
    line = line.split('#')[0].split()
    if len(line) == 2:
        pairs.append(tuple(line))
def dotted(p):
    p = p[:-3]
    if p.endswith('/__init__'): p = p[:-9]
    return p.replace('/', '.')
mods = {dotted(a): dotted(b) for a, b in pairs if a.endswith('.py') and (root/a).exists()}
paths = {a: b for a, b in pairs if (root/a).exists()}
for a,b in pairs:
    if not (root/a).exists(): print('absent', a)
def git(*a): subprocess.run(['git', '-C', str(root), *a], check=True)
tracked = subprocess.run(['git','-C',str(root),'ls-files'],capture_output=True,text=True,check=True).stdout.split('\n')
SKIP = ('proofs/mutation.json','proofs/recheck.json','core/ledger.json','core/ledger/')
def wanted(f):
    return f and not f.startswith('src/') and not any(f.startswith(s) for s in SKIP) and f.rsplit('.',1)[-1] in ('py','md','yaml','yml','toml','json','html','cfg','txt','lark','conf','pyi','sh','in') or f in ('Makefile','.ci/run')
heads = ('core','spec','services','proofs','bridge')
mod_re = re.compile(r'(?<![\w./])((?:cratous\.)?)(' + '|'.join(re.escape(m) for m in sorted(mods, key=len, reverse=True)) + r')(?![\w])')
path_re = re.compile(r'(?<![\w])(' + '|'.join(re.escape(p) for p in sorted(paths, key=len, reverse=True)) + r')(?![\w])')
def from_imports(text):
    """`from cratous.core import a, b as c` whose names are moved modules."""
    try: tree = ast.parse(text)
    except SyntaxError: return text
    lines = text.split('\n')
    edits = []
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module and not node.level and node.module.startswith('cratous.'):
            base = node.module[len('cratous.'):]
            moved, kept = [], []
            for al in node.names:
                full = f'{base}.{al.name}'
                if full in mods and mods[full] != full: moved.append((al, mods[full]))
                else: kept.append(al)
            if not moved: continue
            ind = ' ' * node.col_offset
            out = []
            if kept:
                out.append(f"{ind}from {node.module} import " + ', '.join(a.name + (f' as {a.asname}' if a.asname else '') for a in kept))
            for al, new in moved:
                pk, leaf = new.rsplit('.',1)
                alias = al.asname or al.name
                out.append(f"{ind}from cratous.{pk} import {leaf}" + (f' as {alias}' if alias != leaf else ''))
            edits.append((node.lineno-1, node.end_lineno, out))
    for a, b, out in sorted(edits, reverse=True):
        tail = lines[b-1]
        comment = ''
        m = re.search(r'#.*$', tail)
        if m: out[-1] += '  ' + m.group(0)
        lines[a:b] = out
    return '\n'.join(lines)
spec_names = {m[5:]: n[5:] for m, n in mods.items() if m.startswith('spec.')}
impl_re = re.compile(r'''(implements=|implements ?= ?|implements: )(["'])(''' + '|'.join(re.escape(m) for m in sorted(spec_names, key=len, reverse=True)) + r''')\.''')
changed = 0
for f in tracked:
    if not wanted(f): continue
    p = root/f
    if p.is_symlink() or not p.is_file(): continue
    t = p.read_text(encoding='utf-8')
    n = from_imports(t) if f.endswith('.py') else t
    marks = {}
    # lines that from_imports wrote are new already: protect by only touching what is old
    def sub_mod(m):
        return m.group(1) + mods[m.group(2)]
    if f.endswith('.py'):
        out = []
        before = set(t.split('\n'))
        for line in n.split('\n'):
            if line not in before and re.match(r'\s*from cratous\.', line): out.append(line)
            else: out.append(path_re.sub(lambda m: paths[m.group(1)], mod_re.sub(sub_mod, line)))
        n = '\n'.join(out)
    else:
        n = path_re.sub(lambda m: paths[m.group(1)], mod_re.sub(sub_mod, n))
    n = impl_re.sub(lambda m: m.group(1)+m.group(2)+spec_names[m.group(3)]+'.', n)
    if n != t:
        p.write_text(n, encoding='utf-8'); changed += 1
print('rewritten', changed)
# moves: through temporary names, since a file may become a folder of its name
tmp = []
for a, b in paths.items():
    t = a + '.moving'
    git('mv', a, t); tmp.append((t, b))
for t, b in tmp:
    (root/b).parent.mkdir(parents=True, exist_ok=True)
    git('mv', t, b)
print('moved', len(tmp))

DOC = {
 'core/files': 'Files on disk: written whole or not at all, and what is kept from run to run.',
 'core/readings': 'How one kernel is read: compiled, enclosed in intervals, exactly, or tiered.',
 'core/assignment': 'The assignment of tasks to vehicles: kernels of its steps, and the search that calls them.',
 'core/schedule': 'Order and timing of tasks: constraint rows and the earliest schedule under them.',
 'core/authority': 'Who commands a vehicle: the actuator gate, messages in time, right of way.',
 'core/daa': 'Detect and avoid: alerts, bands, recovery and coordination, from kernels.',
 'core/avoidance': 'Avoidance in flight: trajectories that can be flown, prediction, and resolution.',
 'core/excuse': 'Whether a loss of well clear could have been avoided.',
 'core/routing': 'Routes that can be flown: turns, visibility around zones, laps, wind.',
 'core/tasks': 'What tasks fly and see: lanes over areas, footprints, coverage.',
 'spec/assignment': 'What an assignment problem, its search steps and its lower bounds mean.',
 'spec/authority': 'What authority over a vehicle means: gate, times of messages, right of way.',
 'spec/daa': 'What detect and avoid means, its parameters, and the files they come in.',
 'spec/files': 'Reading what comes from outside: bounds, text, and text made safe to show.',
 'spec/routing': 'What flying a route means: speeds in the wind.',
}
for folder, text in DOC.items():
    f = root/folder/'__init__.py'
    if f.parent.is_dir() and not f.exists():
        f.write_text(f'"""{text}"""\n'); git('add', str(f))
import sys as _s; _s.path.insert(0, str(Path(__file__).parent))
from map2 import TESTS
old_new = {}
for topic, names in TESTS.items():
    for n in names.split():
        a = f'tests/test_{n}.py'
        if (root/a).exists():
            (root/'tests'/topic).mkdir(exist_ok=True)
            p = root/a; t = p.read_text()
            t = t.replace('Path(__file__).resolve().parent.parent.parent', 'Path(__file__).resolve().parents[3]')
            t = t.replace('Path(__file__).resolve().parents[2]', 'Path(__file__).resolve().parents[3]') if 'parents[3]' not in t else t
            t = t.replace('Path(__file__).resolve().parent.parent', 'Path(__file__).resolve().parents[2]').replace('Path(__file__).parent.parent', 'Path(__file__).parents[2]')
            t = t.replace('Path(__file__).parents[1]', 'Path(__file__).parents[2]')
            t = t.replace('Path(__file__).resolve().parent / ', 'Path(__file__).resolve().parents[1] / ').replace('Path(__file__).parent / ', 'Path(__file__).parents[1] / ')
            t = re.sub(r'Path\(__file__\)\.with_name\(("[a-z_]+\.py")\)', r'Path(__file__).parents[1] / \1', t)
            p.write_text(t)
            b = f'tests/{topic}/test_{n}.py'
            git('mv', a, b); old_new[a] = b
tre = re.compile('|'.join(re.escape(a) for a in sorted(old_new, key=len, reverse=True)))
for f in subprocess.run(['git','-C',str(root),'ls-files'],capture_output=True,text=True,check=True).stdout.split('\n'):
    if not wanted(f): continue
    p = root/f
    if p.is_symlink() or not p.is_file(): continue
    t = p.read_text(encoding='utf-8')
    n = tre.sub(lambda m: old_new[m.group(0)], t)
    if n != t: p.write_text(n, encoding='utf-8')
print('tests left', [p.name for p in (root/'tests').glob('test_*.py')])

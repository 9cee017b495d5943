"""Make a small wheel of PyBullet: without data files, examples and debugging symbols.

CPython 3.11 on x86-64 has a wheel on PyPI (99 MB; 280 MB installed), of which the module itself is
kept. Elsewhere the module is built from the source distribution by the CMakeLists.txt beside this
file. Both move alike bit for bit: test/engine/sim/physics/bullet/test_same_bits.py. The result is
3 to 4 MB, in a folder of the cache named by a hash of the download, these files and the Python.
"""

from __future__ import annotations

import argparse
import base64
import hashlib
import os
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import zipfile
from pathlib import Path, PurePosixPath

HERE = Path(__file__).resolve().parent
VERSION = '3.2.7'
WHEEL_HASH = '5d858abf7c12a21ef3ed351cf81dac1b5e486ec25c9ab59bfc84beb89034edff'
SOURCE_HASH = '042879db8d101ac7590dee475fc6aded508b85fe1273fdbbfde1d88bd200e14f'
TAG = f'cp{sys.version_info.major}{sys.version_info.minor}'
PLATFORM = sysconfig.get_platform().replace('-', '_').replace('.', '_')
HAS_WHEEL = (TAG, PLATFORM) == ('cp311', 'linux_x86_64')
# What the build reads of the source distribution, a twentieth of it.
SOURCE_FOLDERS = ('src', 'Extras', 'examples')
SOURCE_SUFFIXES = {'.c', '.cpp', '.h', '.hpp', '.inl'}


def key(from_source: bool) -> str:
    """Return the name of the folder in the cache."""
    digest = hashlib.sha256()
    for path in sorted(HERE.iterdir()):
        if path.is_file():
            digest.update(path.read_bytes())
    python = sysconfig.get_config_var('EXT_SUFFIX')
    digest.update(f'{SOURCE_HASH if from_source else WHEEL_HASH} {python}'.encode())
    return f'pybullet-{VERSION}-{digest.hexdigest()[:16]}'


def wheel_path(cache: Path, from_source: bool) -> Path:
    """Return where the wheel is, or will be."""
    return cache / key(from_source) / f'pybullet-{VERSION}-{TAG}-{TAG}-{PLATFORM}.whl'


def download(folder: Path, from_source: bool) -> Path:
    """Download what PyPI has, checked by its hash; return the file.

    Raises:
        subprocess.CalledProcessError: pip failed, and has said why.
    """
    requirement = folder / 'requirement.txt'
    digest = SOURCE_HASH if from_source else WHEEL_HASH
    requirement.write_text(f'pybullet=={VERSION} --hash=sha256:{digest}\n', encoding='utf-8')
    kind = '--no-binary' if from_source else '--only-binary'
    subprocess.run(
        [
            sys.executable,
            '-m',
            'pip',
            'download',
            '--disable-pip-version-check',
            '--no-input',
            '--no-deps',
            '--no-build-isolation',
            '--require-hashes',
            kind,
            ':all:',
            '--dest',
            str(folder),
            '--requirement',
            str(requirement),
        ],
        check=True,
    )
    (found,) = folder.glob(f'pybullet-{VERSION}*')
    return found


def module_of_wheel(archive: Path, folder: Path) -> Path:
    """Extract the module from a wheel of PyPI, and strip its symbols."""
    with zipfile.ZipFile(archive) as wheel:
        (name,) = [name for name in wheel.namelist() if name.startswith('pybullet.cpython')]
        module = Path(wheel.extract(name, folder))
    subprocess.run(['strip', '--strip-unneeded', str(module)], check=True)
    return module


def is_source(name: str) -> bool:
    """Tell whether a file of the source distribution is needed."""
    path = PurePosixPath(name)
    return (
        len(path.parts) > 2 and path.parts[1] in SOURCE_FOLDERS and path.suffix in SOURCE_SUFFIXES
    )


def module_of_source(archive: Path, folder: Path) -> Path:
    """Build the module from the source distribution; the log shows per cents."""
    with tarfile.open(archive) as sources:
        sources.extraction_filter = lambda member, _: member  # its hash was checked
        sources.extractall(folder, [member for member in sources if is_source(member.name)])
    build = folder / 'build'
    environment = {
        name: value
        for name, value in os.environ.items()
        if name not in ('CFLAGS', 'CXXFLAGS', 'LDFLAGS', 'CC', 'CXX', 'VERBOSE')
    }
    subprocess.run(
        [
            'cmake',
            '-S',
            str(HERE),
            '-B',
            str(build),
            '-DCMAKE_BUILD_TYPE=None',
            f'-DSOURCES={folder}/pybullet-{VERSION}',
            f'-DPython3_EXECUTABLE={sys.executable}',
        ],
        check=True,
        env=environment,
    )
    subprocess.run(
        ['cmake', '--build', str(build), '--parallel', str(os.cpu_count() or 1)],
        check=True,
        env=environment,
    )
    (module,) = build.glob('pybullet*.so')
    return module


def write_wheel(module: Path, path: Path) -> None:
    """Write a wheel that has only this module."""
    suffix = sysconfig.get_config_var('EXT_SUFFIX')
    about = f'pybullet-{VERSION}.dist-info'
    files = {
        f'pybullet{suffix}': module.read_bytes(),
        f'{about}/METADATA': (
            f'Metadata-Version: 2.1\nName: pybullet\nVersion: {VERSION}\nLicense: zlib\n'
        ).encode(),
        f'{about}/WHEEL': (
            'Wheel-Version: 1.0\nGenerator: rosbots_description\n'
            f'Root-Is-Purelib: false\nTag: {TAG}-{TAG}-{PLATFORM}\n'
        ).encode(),
    }
    record = []
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b'=').decode()
        record.append(f'{name},sha256={digest},{len(content)}\n')
    record.append(f'{about}/RECORD,,\n')
    files[f'{about}/RECORD'] = ''.join(record).encode()
    with zipfile.ZipFile(path, 'w', zipfile.ZIP_DEFLATED) as wheel:
        for name, content in files.items():
            wheel.writestr(name, content)


def make(cache: Path, from_source: bool) -> None:
    """Make the wheel in the cache.

    Raises:
        subprocess.CalledProcessError, OSError: a step failed; the cache has no part of a wheel.
    """
    path = wheel_path(cache, from_source)
    cache.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix='new-', dir=cache) as name:
        folder = Path(name)
        archive = download(folder, from_source)
        module = (module_of_source if from_source else module_of_wheel)(archive, folder)
        write_wheel(module, folder / path.name)
        path.parent.mkdir(exist_ok=True)
        (folder / path.name).replace(path)


def title(from_source: bool) -> str:
    """Return a line about what making the wheel takes."""
    if from_source:
        return 'PyBullet, built from its sources (80 MB; once, one to three minutes)'
    return 'PyBullet (99 MB, once)'


def main() -> int:
    """Make the wheel; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('cache', type=Path, help='folder of wheels')
    parser.add_argument(
        '--from-source', action='store_true', default=not HAS_WHEEL, help='even if PyPI has a wheel'
    )
    parser.add_argument('--path', action='store_true', help='only print where the wheel is')
    parser.add_argument('--title', action='store_true', help='only print what making it takes')
    arguments = parser.parse_args()
    if arguments.title:
        print(title(arguments.from_source))
    elif arguments.path:
        print(wheel_path(arguments.cache, arguments.from_source))
    elif not wheel_path(arguments.cache, arguments.from_source).is_file():
        try:
            make(arguments.cache, arguments.from_source)
        except (subprocess.CalledProcessError, OSError) as error:
            print(f'PyBullet: {error}', file=sys.stderr)
            return 1
    return 0


if __name__ == '__main__':
    sys.exit(main())

"""The documentation as a site, which tools/make_site.py builds."""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / 'src'))

project = 'rosbots_description'
extensions = ['myst_parser', 'sphinx.ext.autodoc', 'sphinx.ext.githubpages', 'sphinx.ext.napoleon']
# Of the root, which is the package, only its pages.
include_patterns = [
    'README.md',
    'CONTRIBUTING.md',
    'SECURITY.md',
    'CHANGELOG.rst',
    'doc/*.md',
    'doc/lessons/*.md',
]
root_doc = 'doc/index'
templates_path = ['templates']
html_additional_pages = {'index': 'redirect.html'}
html_theme = 'furo'
html_title = 'rosbots'
myst_heading_anchors = 4  # levels that links may go to, as on GitHub
autodoc_member_order = 'bysource'
autoclass_content = 'both'  # the arguments are told by __init__
default_role = 'code'  # docstrings have their names in single backticks
autodoc_typehints = 'description'

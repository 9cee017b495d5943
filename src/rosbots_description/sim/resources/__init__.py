"""Resolve the addresses of files, open them safely, and write world files."""

from .addresses import Addresses
from .new_file import require_world_path, write_file, write_world
from .packages import PackageSearch
from .safe_io import read_file, regular_state, within
from .scratch import SharedFile, SharedFiles
from .search_path import (
    FileSearch,
    FindModel,
    MissingModel,
    ModelSearch,
    below_model_path,
    description_file,
    find_world,
    model_names,
    not_on_model_path,
    path_directories,
)
from .uris import (
    FindPackage,
    UnknownPackage,
    refuse_parent_folders,
    substitute_in_tree,
)
from .xml_parser import (
    MAX_XML_BYTES,
    check_xml_bounds,
    own_name,
    parse_xml,
    root_tag,
    text_of_upload,
)

__all__ = [
    'MAX_XML_BYTES',
    'Addresses',
    'FileSearch',
    'FindModel',
    'FindPackage',
    'MissingModel',
    'ModelSearch',
    'PackageSearch',
    'SharedFile',
    'SharedFiles',
    'UnknownPackage',
    'below_model_path',
    'check_xml_bounds',
    'description_file',
    'find_world',
    'model_names',
    'not_on_model_path',
    'own_name',
    'parse_xml',
    'path_directories',
    'read_file',
    'refuse_parent_folders',
    'regular_state',
    'require_world_path',
    'root_tag',
    'substitute_in_tree',
    'text_of_upload',
    'within',
    'write_file',
    'write_world',
]

"""Write the robot_namespace of a spawn into a description, as gazebo_ros_pkgs 2.9.2 does."""

from lxml import etree

from ...core import ModelError


def inject_namespace(root: etree._Element, robot_namespace: str) -> None:
    """Give each <plugin>, at any depth, a <robotNamespace> unless it has one, in place.

    An empty `robot_namespace` changes nothing (gazebo_ros_pkgs 2.9.2).

    Raises:
        ModelError: XML cannot hold the text.
    """
    if not robot_namespace:
        return
    for plugin in root.iter('plugin'):
        if plugin.find('robotNamespace') is None:
            child = etree.SubElement(plugin, 'robotNamespace')
            try:
                child.text = robot_namespace
            except ValueError:
                raise ModelError(
                    f"robot_namespace is '{robot_namespace}', which contains a control character; "
                    'use a-z, A-Z, 0-9, _ and /'
                ) from None
            child.sourceline = plugin.sourceline

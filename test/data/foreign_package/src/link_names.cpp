// Reads the bytes of a gazebo_msgs/LinkStates from the file argv[1] and prints what it holds.
#include <cstdint>
#include <fstream>
#include <iostream>
#include <iterator>
#include <vector>

#include <gazebo_msgs/LinkStates.h>
#include <gazebo_msgs/SpawnModel.h>
#include <ros/serialization.h>
#include <ros/service_traits.h>

int main(int argc, char** argv)
{
  if (argc != 2)
    return 2;
  std::ifstream file(argv[1], std::ios::binary);
  std::vector<uint8_t> bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  ros::serialization::IStream stream(bytes.data(), bytes.size());
  gazebo_msgs::LinkStates states;
  ros::serialization::deserialize(stream, states);
  for (std::size_t i = 0; i < states.name.size(); ++i)
    std::cout << states.name[i] << ' ' << states.pose[i].position.z << '\n';
  std::cout << ros::service_traits::md5sum<gazebo_msgs::SpawnModel>() << '\n';
}

; As serve_coffee.lisp, and from where the robot looks at the counter is imagined while it is on its
; way.

(defproblem serve_coffee_looking restaurant
  (
    ; the robot: somewhere on the floor, torso down, arms opened after start-up, hands empty
    (RobotAt floorareatamsrestaurant1)
    (HasTorsoPosture torsodownposture)
    (HasArmPosture leftarm1 armuntuckedposture) (HasArmPosture rightarm1 armuntuckedposture)
    (Holding leftarm1 nothing) (Holding rightarm1 nothing)

    ; guests
    (At guest1 sittingareawesttable1) (At guest2 sittingareaeasttable1)
    (At guest3 sittingareanorthtable2) (At guest4 sittingareasouthtable2)

    ; objects
    (Type coffee mug1) (Type mug mug1) (Type mug mug2)
    (On mug1 placingareaeastrightcounter1) (On mug2 placingareaeastrightcounter1)

    ; switches
    (imagine observe_objects_at))

  ((serve_coffee_to_guest guest1)))
